// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/run/step_row.h"
#include "geometry/rigid_motion.h"
#include "solver/advance.h"
#include "solver/cloth_strain.h"
#include "solver/contact/contacts.h"
#include "solver/mesh_change/step_mesh.h"
#include "solver/sewing/closing.h"
#include "solver/step.h"
#include "solver/velocity_solve/blas_kernel.h"

namespace arris {
namespace {

/// Velocities that differ by less, relative to the greater, are one: rounding of keyframes is below.
constexpr double kSameVelocity = 1e-6;

bool differs(const Vec3& a, const Vec3& b)
{
    return (a - b).norm() > kSameVelocity * std::max(a.norm(), b.norm());
}

/// Whether a contact is that of an EOL vertex with its feature.
bool is_own_of_eol(const ActiveContact& contact)
{
    return contact.kind == ContactKind::Vertex && contact.element == -1;
}

/// Unit direction, in the world, of the edge that a feature is; zero for a corner or point.
Vec3 edge_direction(const ObstaclePose& pose, const FeatureId& on)
{
    if (on.is_fixed()) return Vec3::Zero();
    const int edge = pose->features().edges[static_cast<std::size_t>(on.index)].edge;
    const auto& [a, b] = pose->topology().edges[static_cast<std::size_t>(edge)].points;
    const std::vector<Vec3>& points = pose->mesh().points;
    return pose.placement.rotation * (points[b] - points[a]).stableNormalized();
}

}  // namespace

Checkpoint start_checkpoint(const RunConfig& config, SceneSource source)
{
    Checkpoint start;
    start.source = std::move(source);
    start.warnings = config.warnings;
    start.kernel = blas_kernel();
    start.pieces = config.pieces;
    start.seams.assign(config.seams.begin(), config.seams.end());
    start.labels = config.labels;
    State& state = start.state = make_state(config.scene, config.cloth, config.cloth_velocity);
    for (std::size_t s = 0; s < config.seams.size(); ++s)
        for (const auto& [v, w] : config.seams[s].pairs)
            state.seam_pairs.push_back(
                {{state.ids[static_cast<std::size_t>(v)], state.ids[static_cast<std::size_t>(w)]},
                 static_cast<std::int32_t>(s),
                 distance_of(config, {v, w})});
    if (config.is_assembly) {
        start.assembly_duration = config.duration;
        advance_sewing(config.scene, state);
    } else {  // what is left are ties: closed, or kept as they are
        for (SeamPair& pair : state.seam_pairs)
            if (pair.gap <= closed_gap(config.scene)) pair.gap = 0.0;
        state.closing.order = Closing::kAllClosed;
        state.sewn_at = 0.0;
    }
    return start;
}

bool Simulation::is_sewn() const
{
    const double since =
        state().time - state().sewn_at;  // at least a step, which measures the cloth as it is now
    return config_.is_assembly && since > 0.0 && since >= config_.scene.sewing->settle;
}

double Simulation::expected_end() const
{
    if (!config_.is_assembly) return config_.duration;
    const double closed =
        std::isfinite(state().sewn_at) ? state().sewn_at : std::max(state().closing.end, state().time);
    return closed + config_.scene.sewing->settle;
}

Simulation::Simulation(RunConfig config, Checkpoint at)
    : config_(std::move(config)),
      pins_(config_.scene.pins),
      obstacles_(config_.scene.obstacles),
      timeline_(config_)
{
    go_to(std::move(at));
}

void Simulation::go_to(Checkpoint at)
{
    at_ = std::move(at);
    opening_.reset();
    work_ = {};
    apply_given();
    prepare(config_.scene, at_.state, work_);
}

State Simulation::part_with_state()
{
    State copy = at_.state;
    return std::exchange(at_.state, std::move(copy));
}

void Simulation::tell_start(double seconds, const OnRow& on_row)
{
    StepReport initial;
    initial.seconds.advance = seconds;
    write_row(initial, false, on_row);
}

/// Measures the current state, and gives it as a row.
void Simulation::write_row(const StepReport& report, bool is_halved, const OnRow& on_row)
{
    Stopwatch watch;
    State& state = at_.state;
    prepare(config_.scene, state, work_);  // rebuilds elements where material has flowed
    const std::int64_t frame = timeline_.frame_at(state.time);
    const bool is_audited = frame >= 0 || state.time >= config_.duration;
    audited_ = is_audited ? audit(config_.scene, state) : Audit();
    crossed_ = is_audited ? find_self_crossings(config_.scene, state.mesh) : SelfCrossings();
    state.crossings += crossed_.count;
    StepRow row = make_step_row(config_, state, work_, audited_, report);
    row.step = at_.rows;
    row.is_halved = is_halved;
    MeshCache& mesh = work_.mesh;
    const ClothStrain strain = measure_cloth_strain(config_.scene.materials, find_stretches(state, mesh),
                                                    state.mesh, mesh.stars.faces);
    row.max_strain = strain.greatest();
    note_strain(state, strain, at_.strain);
    note_friction(report, state.time, at_.friction);
    row.seconds.output += watch.lap();
    if (row.is_touching()) ++at_.touching_rows;
    on_row(row);
    if (frame >= 0) at_.frames = frame + 1;
    ++at_.rows;
    since_row_.lap();
}

std::optional<RunEnding> Simulation::step(const OnRow& on_row)
{
    const auto interrupted = [&] {
        return RunEnding{RunStatus::Interrupted, fmt::format("stopped at t = {:.6g} s", at_.state.time)};
    };
    const Settings& settings = config_.settings;
    if (settings.is_interrupted && settings.is_interrupted()) return interrupted();
    const RunProgress before = at_;
    State& state = at_.state;
    const double begin = state.time;
    const bool is_given_jump = move_on_given();
    if (timeline_.jumps_at(state.time) || is_given_jump) restart(state);
    const auto accept = [&](const StepReport& report, bool is_halved) {
        at_.gamma = work_.prediction.gamma;
        if (report.part == StepPart::Opening) {
            opening_ = report;
            return true;
        }
        write_row(opening_ ? join_parts(*opening_, report) : report, is_halved, on_row);
        opening_.reset();
        return audited_.obstacle < 0 && crossed_.count == 0;
    };
    std::optional<StepReport> failed;
    try {
        failed = advance(config_.scene, settings, timeline_.next_end(at_.position), state, work_, accept);
    } catch (const Interrupted&) {  // a resumed run makes the whole planned step again
        static_cast<RunProgress&>(at_) = before;
        opening_.reset();
        apply_given();
        return interrupted();
    }
    if (failed) {
        if (opening_)  // the rest of this step has failed
            write_row(*std::exchange(opening_, std::nullopt), true, on_row);
        return explain_ending(*failed, settings.tolerance, config_.scene, state);
    }
    if (audited_.obstacle >= 0) return explain_ending(audited_, config_.scene, state);
    if (crossed_.count > 0) return explain_ending(crossed_, state);
    at_.position = timeline_.next(at_.position);
    if (!config_.is_assembly) return std::nullopt;
    slow_down(state.time - begin, state);
    advance_sewing(config_.scene, state);
    prepare(config_.scene, state, work_);  // for readings between two steps
    return find_unsewn();
}

std::optional<RunEnding> Simulation::find_unsewn() const
{
    if (!config_.is_assembly || std::isfinite(state().sewn_at) || !timeline_.is_over(at_.position))
        return std::nullopt;
    return explain_unsewn(config_.scene, state());
}

Placement Simulation::placement(const Mover& mover) const
{
    const auto i = static_cast<std::size_t>(mover.index);
    const Scene& scene = config_.scene;
    return mover.is_pin ? scene.pins[i].motion.at(state().time)
                        : scene.obstacles[i].at(state().time).placement;
}

/// The motion given to a pin or an obstacle; at first one as it moves in the scene.
GivenMotion& Simulation::given(const Mover& mover)
{
    const auto known = std::find_if(at_.given.begin(), at_.given.end(),
                                    [&](const GivenMotion& given) { return given.mover == mover; });
    if (known != at_.given.end()) return *known;
    GivenMotion motion{.mover = mover, .keyframes = {}};
    const auto i = static_cast<std::size_t>(mover.index);
    const Vec3 origin = placement(mover).translation;
    const auto velocity_at = [&](const Vec3& place) -> Vec3 {
        return mover.is_pin ? config_.scene.pins[i].motion.velocity_after(state().time, place)
                            : config_.scene.obstacles[i].velocity_after(state().time, place);
    };
    motion.last_velocity = velocity_at(origin);
    // The cross products of the angular velocity with the axes x and y.
    const Vec3 x = velocity_at(origin + Vec3::UnitX()) - motion.last_velocity;
    const Vec3 y = velocity_at(origin + Vec3::UnitY()) - motion.last_velocity;
    motion.last_turn = {y.z(), -x.z(), x.y()};
    at_.given.push_back(std::move(motion));
    return at_.given.back();
}

void Simulation::place(const Mover& mover, const Placement& to)
{
    GivenMotion& motion = given(mover);
    motion.is_driven = false;
    set_keyframes(motion, to);
}

void Simulation::drive(const Mover& mover, const Vec3& velocity, const Vec3& angular_velocity,
                       const Vec3& pivot)
{
    GivenMotion& motion = given(mover);
    const Vec3 origin = placement(mover).translation;
    const bool was_driven = motion.is_driven;
    const Vec3 before = was_driven ? driven_velocity(motion, origin) : motion.last_velocity;
    const Vec3 turn_before = was_driven ? motion.angular_velocity : motion.last_turn;
    motion.is_driven = true;
    motion.velocity = velocity;
    motion.angular_velocity = angular_velocity;
    motion.pivot = pivot;
    motion.pivot_time = state().time;
    motion.is_jump |=
        differs(driven_velocity(motion, origin), before) || differs(angular_velocity, turn_before);
}

/// The current pivot of a driven motion, m.
Vec3 Simulation::pivot_of(const GivenMotion& given) const
{
    return given.pivot + (state().time - given.pivot_time) * given.velocity;
}

/// Velocity, m/s, now, of a point that is at `place` and driven.
Vec3 Simulation::driven_velocity(const GivenMotion& given, const Vec3& place) const
{
    return given.velocity + given.angular_velocity.cross(place - pivot_of(given));
}

/// Moves it to a placement at the end of the next step.
void Simulation::set_keyframes(GivenMotion& given, const Placement& to)
{
    const Placement from = placement(given.mover);
    given.keyframes = {{state().time, from.translation, Eigen::Quaterniond(from.rotation)},
                       {timeline_.next_end(at_.position), to.translation, Eigen::Quaterniond(to.rotation)}};
    apply(given);
}

/// The placement to which its velocities bring it by the end of the next step.
Placement Simulation::driven_placement(const GivenMotion& given) const
{
    const double dt = timeline_.next_end(at_.position) - state().time;
    const Vec3 turn = dt * given.angular_velocity;
    const Mat3 rotation = Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).toRotationMatrix();
    const Vec3 pivot = pivot_of(given);
    const Placement from = placement(given.mover);
    return {rotation * from.rotation, pivot + dt * given.velocity + rotation * (from.translation - pivot)};
}

/// Moves what is driven on through the next step. Returns whether the velocity of any given motion jumps at
/// the step's begin.
bool Simulation::move_on_given()
{
    bool is_jump = false;
    for (GivenMotion& given : at_.given) {
        if (given.is_driven) set_keyframes(given, driven_placement(given));
        Vec3 velocity = Vec3::Zero(), turn = Vec3::Zero();
        const Keyframe &from = given.keyframes.front(), &to = given.keyframes.back();
        if (state().time < to.time) {
            const double dt = to.time - from.time;
            Eigen::Quaterniond turned = to.rotate * from.rotate.conjugate();
            if (turned.w() < 0.0) turned.coeffs() *= -1.0;  // the shorter arc
            const Eigen::AngleAxisd about(turned);
            velocity = (to.translate - from.translate) / dt;
            turn = about.angle() / dt * about.axis();
        }
        // The origin of what turns about a pivot changes its velocity all the time.
        is_jump |= given.is_driven ? given.is_jump
                                   : differs(velocity, given.last_velocity) || differs(turn, given.last_turn);
        given.is_jump = false;
        given.last_velocity = velocity;
        given.last_turn = turn;
    }
    return is_jump;
}

/// Puts the motions of the scene, and those given in their place, into effect.
void Simulation::apply_given()
{
    config_.scene.pins = pins_;
    config_.scene.obstacles = obstacles_;
    for (const GivenMotion& given : at_.given) apply(given);
}

void Simulation::apply(const GivenMotion& given)
{
    if (given.keyframes.empty()) return;
    RigidMotion motion;
    motion.keyframes = given.keyframes;
    const auto i = static_cast<std::size_t>(given.mover.index);
    if (given.mover.is_pin)
        config_.scene.pins[i].motion = std::move(motion);
    else
        config_.scene.obstacles[i].follow(std::move(motion));
}

std::vector<ContactReading> Simulation::contacts() const
{
    const auto pose_of = [&](int obstacle) {
        return config_.scene.obstacles[static_cast<std::size_t>(obstacle)].at(state().time);
    };
    std::vector<ContactReading> readings;
    for (const ActiveContact& contact : state().active) {
        if (is_own_of_eol(contact)) continue;  // below: the multiplier is a part of what its feature exerts
        Mat3 rotation = Mat3::Identity();
        if (contact.obstacle != kClothItself) rotation = pose_of(contact.obstacle).placement.rotation;
        ContactReading reading;
        for (std::size_t k = 0; k < reading.vertices.size(); ++k)
            reading.vertices[k] = state().index_of(contact.vertex_ids[k]);
        reading.obstacle = contact.obstacle;
        reading.force = contact.multiplier / at_.gamma * (rotation * contact.normal);
        reading.friction = rotation * contact.friction.force;
        readings.push_back(reading);
    }
    for (const EolVertex& vertex : state().eol) {
        if (vertex.force.isZero(0.0)) continue;
        const Vec3 along = edge_direction(pose_of(vertex.on.obstacle), vertex.on);
        const Vec3 friction = vertex.force.dot(along) * along;
        readings.push_back({{state().index_of(vertex.vertex_id), -1, -1, -1},
                            vertex.on.obstacle,
                            vertex.force - friction,
                            friction});
    }
    return readings;
}

Frame Simulation::frame() const
{
    Frame frame = make_frame(config_.scene.obstacles, state(), work_.mesh.elements, work_.mesh.terms);
    if (config_.pieces.size() > 1) frame.pieces.assign(config_.pieces.begin(), config_.pieces.end());
    return frame;
}

}  // namespace arris
