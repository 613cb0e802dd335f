// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/bindings/core.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "app/files/csv_table.h"
#include "app/files/frame.h"
#include "app/run/resumed_scene.h"
#include "app/run/run_warnings.h"
#include "app/scene/parts/assembly.h"
#include "app/scene/scene_load.h"
#include "geometry/input_error.h"
#include "solver/contact/contacts.h"

namespace arris {

namespace py = pybind11;

/// A state whose arrays views refer to; empty while it is the simulation's own.
struct Core::Kept {
    std::optional<State> state;
};

namespace {

/// Simulations take turns: side by side their last bits differ (measured), so that libraries beneath share
/// state. A signal's handler may use another simulation within a step.
std::recursive_mutex computing;
std::atomic<int> steps_in_progress{0};
std::atomic<bool> is_process_ending{false};

/// Whether a signal's handler has raised an exception, such as KeyboardInterrupt, or the process ends. Asks
/// Python at most every 20 ms, as that takes the GIL.
bool is_to_stop()
{
    if (is_process_ending) return true;
    using Clock = std::chrono::steady_clock;
    static std::atomic<Clock::rep> asked{0};
    const Clock::rep now = Clock::now().time_since_epoch().count();
    constexpr Clock::rep kBetween =
        std::chrono::duration_cast<Clock::duration>(std::chrono::milliseconds(20)).count();
    if (now - asked < kBetween) return false;
    asked = now;
    const py::gil_scoped_acquire gil;
    return PyErr_CheckSignals() != 0;
}

/// The scene with its seams closed. Throws InputError where they do not close, and what a signal's handler
/// has raised.
RunConfig sew(const RunConfig& unsewn, const SceneSource& source)
{
    RunConfig assembly = make_assembly(unsewn);
    Checkpoint start = start_checkpoint(assembly, source);
    Simulation simulation(std::move(assembly), std::move(start));
    simulation.watch(is_to_stop);
    while (!simulation.is_over()) {
        const std::optional<RunEnding> ending = simulation.step([](StepRow&) {});
        if (!ending) continue;
        if (ending->status == RunStatus::Interrupted) {
            const py::gil_scoped_acquire gil;
            throw py::error_already_set();
        }
        if (ending->status == RunStatus::Unsewn && keeps_unsewn(unsewn)) break;
        throw InputError(fmt::format("{}: {}", source.path, ending->message));
    }
    return load_sewn(source, simulation.at(), unsewn);
}

Simulation make_simulation(SceneSource source, const std::vector<std::string>& importer)
{
    LoadOptions options;
    options.importer = importer;
    const py::gil_scoped_release no_gil;
    const std::scoped_lock turn(computing);
    RunConfig config = load_scene(source, options);
    source.path = std::filesystem::absolute(source.path).string();
    if (needs_assembly(config)) config = sew(config, source);
    Checkpoint start = start_checkpoint(config, std::move(source));
    return Simulation(std::move(config), std::move(start));
}

template <class Scalar, class Item>
py::array make_array(const std::vector<Item>& items, std::size_t width)
{
    py::array_t<Scalar> array({items.size(), width});
    auto at = array.template mutable_unchecked<2>();
    for (std::size_t i = 0; i < items.size(); ++i)
        for (std::size_t k = 0; k < width; ++k)
            at(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(k)) = static_cast<Scalar>(items[i][k]);
    return array;
}

}  // namespace

Core::Core(const std::string& path, const std::string& text, const std::vector<std::string>& overrides,
           const std::vector<std::string>& importer)
    : simulation_(make_simulation({path, text, overrides}, importer))
{
    simulation_.watch(is_to_stop);
    simulation_.tell_start(0.0, [](StepRow&) {});
}

/// Marks a simulation as busy, while Python runs without it: in other threads, and in signals' handlers.
class Core::Busy {
  public:
    explicit Busy(Core& core) : core_(core)
    {
        core.require_idle();
        core.is_busy_ = true;
        ++steps_in_progress;
    }
    ~Busy()
    {
        core_.is_busy_ = false;
        --steps_in_progress;
    }

  private:
    Core& core_;
};

void Core::require_idle() const
{
    if (is_busy_)
        throw std::runtime_error(
            "the simulation is in a step, of another thread or of the code that a signal has interrupted");
}

const Simulation& Core::idle() const
{
    require_idle();
    return simulation_;
}

void end_steps()
{
    is_process_ending = true;
    const py::gil_scoped_release no_gil;
    while (steps_in_progress > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

Core::Stepped Core::step()
{
    if (is_over())
        throw InputError(
            fmt::format("step: the simulation has reached its end, t = {} s; allowed: a longer "
                        "'duration' of the scene",
                        time()));
    const Busy busy(*this);
    part_with_views();
    Stepped stepped;
    std::optional<RunEnding> ending;
    {
        const py::gil_scoped_release no_gil;
        const std::scoped_lock turn(computing);
        ending = simulation_.step([&](StepRow& row) { stepped.rows.push_back(format_row(row)); });
    }
    if (PyErr_Occurred()) throw py::error_already_set();
    if (ending) {
        stepped.status = to_string(ending->status);
        stepped.message = ending->message;
    }
    return stepped;
}

// ---- arrays

void Core::part_with_views()
{
    if (const std::shared_ptr<Kept> views = views_.lock()) views->state = simulation_.part_with_state();
    views_.reset();
}

/// The first `count` items as an array of a row each, read-only.
template <class Scalar, class Item>
py::array Core::view(const std::vector<Item>& items, std::size_t count)
{
    constexpr std::size_t width = sizeof(Item) / sizeof(Scalar);
    std::shared_ptr<Kept> kept = views_.lock();
    if (!kept) views_ = kept = std::make_shared<Kept>();
    const py::capsule owner(new std::shared_ptr<Kept>(std::move(kept)),
                            [](void* held) { delete static_cast<std::shared_ptr<Kept>*>(held); });
    py::array array(py::dtype::of<Scalar>(), {count, width}, {sizeof(Item), sizeof(Scalar)}, items.data(),
                    owner);
    array.attr("flags").attr("writeable") = false;
    return array;
}

py::array Core::positions()
{
    const std::vector<Vec3>& world = idle().state().mesh.world;
    return view<double>(world, world.size());
}

py::array Core::velocities()
{
    const std::vector<Vec3>& velocity = idle().state().velocity;
    return view<double>(velocity, velocity.size());
}

py::array Core::material()
{
    const ClothMesh& mesh = idle().state().mesh;
    return view<double>(mesh.material, mesh.world.size());
}

py::array Core::material_points()
{
    const std::vector<Vec2>& material = idle().state().mesh.material;
    return view<double>(material, material.size());
}

py::array Core::faces()
{
    const std::vector<Face>& faces = idle().state().mesh.faces;
    return view<int>(faces, faces.size());
}

py::array Core::face_points()
{
    const ClothMesh& mesh = idle().state().mesh;
    const std::vector<Face>& points = mesh.has_seams() ? mesh.face_points : mesh.faces;
    return view<int>(points, points.size());
}

py::array Core::eol() const
{
    const std::vector<std::uint8_t> kinds = eol_kinds(idle().state());
    return py::array_t<std::uint8_t>(static_cast<py::ssize_t>(kinds.size()), kinds.data());
}

py::dict Core::contacts() const
{
    const std::vector<ContactReading> readings = idle().contacts();
    std::vector<std::array<int, 4>> vertices;
    std::vector<Vec3> forces, frictions;
    py::list obstacles;
    for (const ContactReading& reading : readings) {
        vertices.push_back(reading.vertices);
        forces.push_back(reading.force);
        frictions.push_back(reading.friction);
        obstacles.append(
            reading.obstacle == kClothItself
                ? std::string("cloth")
                : simulation_.config().scene.obstacles[static_cast<std::size_t>(reading.obstacle)].name());
    }
    py::dict contacts;
    contacts["vertices"] = make_array<int>(vertices, 4);
    contacts["with"] = obstacles;
    contacts["force"] = make_array<double>(forces, 3);
    contacts["friction"] = make_array<double>(frictions, 3);
    return contacts;
}

// ---- readings

py::dict Core::energies() const
{
    const ClothEnergy energy = idle().energy();
    py::dict energies;
    energies["kinetic"] = energy.kinetic;
    energies["gravity"] = energy.potential.gravity;
    energies["stretch"] = energy.potential.stretch;
    energies["bending"] = energy.potential.bending;
    return energies;
}

py::dict Core::probes() const
{
    py::dict probes;
    const std::vector<ProbeSample> samples = idle().probes();
    for (std::size_t i = 0; i < samples.size(); ++i)
        probes[simulation_.config().probes[i].name.c_str()] =
            make_array<double>(std::vector<Vec3>{samples[i].position, samples[i].velocity}, 3);
    return probes;
}

std::vector<std::string> Core::obstacle_names() const
{
    std::vector<std::string> names;
    for (const MovingObstacle& obstacle : simulation_.config().scene.obstacles)
        names.push_back(obstacle.name());
    return names;
}

std::vector<std::string> Core::warnings_at_end() const
{
    return warn_at_end(simulation_.config(), idle().at(), RunStatus::Finished);
}

void Core::write_frame(const std::string& path) const
{
    arris::write_frame(path, idle().frame());
}

// ---- motion and state

Mover Core::pin(int index) const
{
    const std::vector<Pin>& pins = simulation_.config().scene.pins;
    const int count = static_cast<int>(pins.size());
    if (index < 0 || index >= count)
        throw InputError(count == 0
                             ? fmt::format("pin {}: the scene has no [[pin]]", index)
                             : fmt::format("pin {}: is not there; allowed: 0 to {}", index, count - 1));
    if (pins[static_cast<std::size_t>(index)].follows)
        throw InputError(fmt::format("pin {}: follows an obstacle; allowed: a pin without 'follow'", index));
    return {true, index};
}

Mover Core::obstacle(const std::string& name) const
{
    const std::vector<std::string> names = obstacle_names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        throw InputError(names.empty() ? fmt::format("obstacle '{}': the scene has no [[obstacle]]", name)
                                       : fmt::format("obstacle '{}': is not there; allowed: {}", name,
                                                     fmt::join(names, ", ")));
    const auto index = static_cast<std::int32_t>(found - names.begin());
    if (simulation_.config().scene.obstacles[static_cast<std::size_t>(index)].is_deforming())
        throw InputError(fmt::format("obstacle '{}': deforms; allowed: a rigid one", name));
    return {false, index};
}

void Core::place(const Mover& mover, const Mat3& rotation, const Vec3& translation)
{
    require_idle();
    simulation_.place(mover, {rotation, translation});
}

void Core::drive(const Mover& mover, const Vec3& velocity, const Vec3& angular_velocity, const Vec3& pivot)
{
    require_idle();
    simulation_.drive(mover, velocity, angular_velocity, pivot);
}

void Core::load(const std::string& bytes)
{
    require_idle();
    const std::string name = "state";
    Checkpoint at = parse_checkpoint(bytes, name);
    const SceneSource& own = simulation_.at().source;
    if (at.source.text != own.text || at.source.overrides != own.overrides)
        throw InputError(
            "state: belongs to another scene; allowed: a state that a simulation of this scene, with "
            "the same 'set', has saved");
    check_references(name, at, simulation_.config().scene);
    const Timeline& timeline = simulation_.timeline();
    if (!timeline.is_over(at.position) && !(timeline.next_end(at.position) > at.state.time))
        throw InputError("state: is damaged: its time is not within its step");
    part_with_views();
    simulation_.go_to(std::move(at));
}

}  // namespace arris
