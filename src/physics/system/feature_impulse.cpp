// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/system/feature_impulse.h"

#include <Eigen/Geometry>

#include "physics/elements/eulerian_element.h"
#include "physics/elements/momentum_flux.h"

namespace arris {

namespace {

/// Calls `put(vertex, A w' - b)` for each EOL corner of an element.
template <int N, typename Put>
void visit_residual(const std::array<int, N>& vertices, const std::array<int, N>& points,
                    const LocalSystem<N>& local, const Linearization& at, const Eigen::VectorXd& u,
                    const Put& put)
{
    std::array<Vec3, N> w;
    for (int j = 0; j < N; ++j) {
        const int v = vertices[j];
        w[j] =
            corner_matrix(local.deformation(j), at.basis[v], at.flow->basis[points[j]]) * u.segment<3>(3 * v);
    }
    for (int i = 0; i < N; ++i) {
        if (!at.flow->is_eulerian[vertices[i]]) continue;
        Vec3 sum = -local.rhs(i);
        for (int j = 0; j < N; ++j) {
            if (j <= i)
                sum += local.matrix(i, j) * w[j];
            else
                sum += local.matrix(j, i).transpose() * w[j];
        }
        put(vertices[i], sum);
    }
}

template <typename Put>
void visit_face(const FaceElement& element, const Terms& terms, const Linearization& at,
                const Eigen::VectorXd& u, const Put& put)
{
    for (const FaceSystem& local :
         {eulerian_inertia_and_loads(element, terms, at), eulerian_elasticity(element, terms, at)})
        visit_residual<3>(element.vertices, element.points, local, at, u, put);
}

template <typename Put>
void visit_hinge(const HingeElement& hinge, const HingeMoment* moment, const ClothElements& elements,
                 const Terms& terms, const Linearization& at, const Eigen::VectorXd& u, const Put& put)
{
    visit_residual<4>(hinge.vertices, points_of(hinge, elements),
                      eulerian_hinge(hinge, moment, elements, terms, at), at, u, put);
}

/// Subtracts loads on EOL vertices, evaluated at the extrapolated material coordinates.
void subtract_loads(const ClothMesh& mesh, const Terms& terms, const Linearization& at,
                    std::vector<Vec3>& impulse)
{
    if (terms.loads.empty()) return;
    ClothMesh flowed = mesh;
    flowed.material = at.flow->extrapolated.material;
    std::vector<Vec3> load(impulse.size(), Vec3::Zero());
    for (const auto& term : terms.loads) term->add(flowed, at, load);
    for (std::size_t v = 0; v < impulse.size(); ++v)
        if (at.flow->is_eulerian[v]) impulse[v] -= at.gamma * load[v];
}

/// The trace vertices' sides, found by vertex.
class SidesByVertex {
  public:
    SidesByVertex(const std::vector<TraceVertex>& vertices, const Linearization& at)
        : sides(vertices.size()), vertices_(vertices), at_(at), slot_(at.position.size(), -1)
    {
        for (std::size_t k = 0; k < vertices.size(); ++k) slot_[vertices[k].vertex] = static_cast<int>(k);
    }

    TraceSides* find(int vertex) { return slot_[vertex] < 0 ? nullptr : &sides[slot_[vertex]]; }

    /// 0 where the face lies to the left of the vertex's trace, 1 where it lies to the right.
    int side_of(int vertex, const FaceElement& face) const
    {
        const std::vector<Vec2>& X = at_.flow->position;
        const auto& [a, b, c] = face.points;
        int k = 0;
        while (face.vertices[k] != vertex) ++k;
        const int point = face.points[k];
        const Vec2 middle = X[a] + X[b] + X[c] - 3.0 * X[point];
        Vec2 trace = vertices_[slot_[vertex]].trace;
        if (point != vertex)  // beyond a seam, along which material flows
            trace = turn_between(at_.flow->basis[vertex].col(2), at_.flow->basis[point].col(2)) * trace;
        return trace.x() * middle.y() - trace.y() * middle.x() > 0.0 ? 0 : 1;
    }

    std::vector<TraceSides> sides;

  private:
    const std::vector<TraceVertex>& vertices_;
    const Linearization& at_;
    std::vector<int> slot_;  ///< by vertex
};

void add_face(const FaceElement& element, const Terms& terms, const Linearization& at,
              const Eigen::VectorXd& u, SidesByVertex& by_vertex)
{
    const Face& face = element.vertices;
    const auto put = [&](int v, const Vec3& residual) {
        if (TraceSides* sides = by_vertex.find(v)) sides->impulse[by_vertex.side_of(v, element)] += residual;
    };
    visit_face(element, terms, at, u, put);
    const std::vector<Vec3>& x = at.position;
    const Vec3 normal = (x[face[1]] - x[face[0]]).cross(x[face[2]] - x[face[0]]);
    for (const int v : face)
        if (TraceSides* sides = by_vertex.find(v)) {
            const int k = by_vertex.side_of(v, element);
            sides->normal[k] += normal;
            sides->leaving[k] += element.area * (x[face[0]] + x[face[1]] + x[face[2]] - 3.0 * x[v]);
        }
}

void add_hinge(const HingeElement& hinge, const HingeMoment* moment, const ClothElements& elements,
               const Terms& terms, const Linearization& at, const Eigen::VectorXd& u,
               SidesByVertex& by_vertex)
{
    const auto put = [&](int v, const Vec3& residual) {
        TraceSides* sides = by_vertex.find(v);
        if (sides == nullptr) return;
        std::vector<int> at_vertex;  // sides of the hinge's faces with this corner
        for (const int f : hinge.faces) {
            const FaceElement& face = elements.faces[f];
            if (std::find(face.vertices.begin(), face.vertices.end(), v) != face.vertices.end())
                at_vertex.push_back(by_vertex.side_of(v, face));
        }
        for (const int k : at_vertex) sides->impulse[k] += residual / static_cast<double>(at_vertex.size());
    };
    visit_hinge(hinge, moment, elements, terms, at, u, put);
}

/// Calls `visit(hinge, moment)` for each hinge with terms and an EOL vertex.
template <typename Visit>
void visit_eulerian_hinges(const ClothElements& elements, const Terms& terms, const Linearization& at,
                           const Visit& visit)
{
    if (terms.hinges.empty()) return;
    const HingeStates states(elements, terms, at);
    for (std::size_t h = 0; h < elements.hinges.size(); ++h)
        if (has_eulerian_vertex(*at.flow, elements.hinges[h].vertices))
            visit(elements.hinges[h], states.moment(h));
}

}  // namespace

std::vector<Vec3> compute_feature_impulses(const ClothMesh& mesh, const ClothElements& elements,
                                           const Terms& terms, const Linearization& at,
                                           const Eigen::VectorXd& u)
{
    std::vector<Vec3> impulse(elements.vertex_count, Vec3::Zero());
    if (!at.flow) return impulse;
    const auto put = [&](int v, const Vec3& residual) { impulse[v] += residual; };
    for (const FaceElement& element : elements.faces) {
        if (has_eulerian_vertex(*at.flow, element.vertices)) visit_face(element, terms, at, u, put);
    }
    visit_eulerian_hinges(elements, terms, at, [&](const HingeElement& hinge, const HingeMoment* moment) {
        visit_hinge(hinge, moment, elements, terms, at, u, put);
    });
    for (const CreaseForce& crease : find_momentum_flux(terms.materials, elements, at))
        for (int i = 0; i < 2; ++i)
            if (at.flow->is_eulerian[crease.vertices[i]])
                impulse[crease.vertices[i]] -= at.gamma * crease.force[i];
    subtract_loads(mesh, terms, at, impulse);
    return impulse;
}

std::vector<TraceSides> compute_trace_sides(const std::vector<TraceVertex>& vertices,
                                            const ClothElements& elements, const Terms& terms,
                                            const Linearization& at, const Eigen::VectorXd& u)
{
    SidesByVertex by_vertex(vertices, at);
    for (const FaceElement& element : elements.faces)
        if (has_eulerian_vertex(*at.flow, element.vertices)) add_face(element, terms, at, u, by_vertex);
    visit_eulerian_hinges(elements, terms, at, [&](const HingeElement& hinge, const HingeMoment* moment) {
        add_hinge(hinge, moment, elements, terms, at, u, by_vertex);
    });
    for (const CreaseForce& crease : find_momentum_flux(terms.materials, elements, at))
        for (int i = 0; i < 2; ++i)
            if (TraceSides* sides = by_vertex.find(crease.vertices[i]))
                sides->flux += at.gamma * crease.force[i];
    return std::move(by_vertex.sides);
}

}  // namespace arris
