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
#include "solver/step.h"
#include "solver/velocity_solve/blas_kernel.h"

namespace arris {

Checkpoint start_checkpoint(const RunConfig& config, SceneSource source)
{
    Checkpoint start;
    start.source = std::move(source);
    start.warnings = config.warnings;
    start.kernel = blas_kernel();
    start.pieces = config.pieces;
    start.state = make_state(config.scene, config.cloth, config.cloth_velocity);
    return start;
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
    config_.scene.pins = pins_;
    config_.scene.obstacles = obstacles_;
    for (const GivenMotion& given : at_.given) apply(given);
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
    at_.gamma = work_.prediction.gamma;
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
    if (timeline_.jumps_at(state.time)) restart(state);
    for (GivenMotion& given : at_.given)
        if (given.is_driven) drive_on(given);
    const auto accept = [&](const StepReport& report, bool is_halved) {
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
    return std::nullopt;
}

Placement Simulation::placement(const Mover& mover) const
{
    const auto i = static_cast<std::size_t>(mover.index);
    const Scene& scene = config_.scene;
    return mover.is_pin ? scene.pins[i].motion.at(state().time)
                        : scene.obstacles[i].at(state().time).placement;
}

GivenMotion& Simulation::given(const Mover& mover)
{
    const auto known = std::find_if(at_.given.begin(), at_.given.end(),
                                    [&](const GivenMotion& given) { return given.mover == mover; });
    if (known != at_.given.end()) return *known;
    at_.given.push_back({.mover = mover, .keyframes = {}});
    return at_.given.back();
}

void Simulation::place(const Mover& mover, const Placement& to)
{
    GivenMotion& motion = given(mover);
    motion.is_driven = false;
    move_on(motion, to);
}

void Simulation::drive(const Mover& mover, const Vec3& velocity, const Vec3& angular_velocity,
                       const Vec3& pivot)
{
    GivenMotion& motion = given(mover);
    motion.is_driven = true;
    motion.velocity = velocity;
    motion.angular_velocity = angular_velocity;
    motion.pivot = pivot;
}

/// Moves it to a placement at the end of the next step.
void Simulation::move_on(GivenMotion& given, const Placement& to)
{
    const Placement from = placement(given.mover);
    given.keyframes = {{state().time, from.translation, Eigen::Quaterniond(from.rotation)},
                       {timeline_.next_end(at_.position), to.translation, Eigen::Quaterniond(to.rotation)}};
    apply(given);
}

/// Moves it on with its velocities until the end of the next step.
void Simulation::drive_on(GivenMotion& given)
{
    const double dt = timeline_.next_end(at_.position) - state().time;
    const Vec3 turn = dt * given.angular_velocity;
    const Mat3 rotation = Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).toRotationMatrix();
    const Vec3 pivot = given.pivot + dt * given.velocity;
    const Placement from = placement(given.mover);
    move_on(given, {rotation * from.rotation, pivot + rotation * (from.translation - given.pivot)});
    given.pivot = pivot;
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
    std::vector<ContactReading> readings;
    for (const ActiveContact& contact : state().active) {
        if (is_fold_plane(contact)) continue;  // no obstacle's surface
        Mat3 rotation = Mat3::Identity();
        if (contact.obstacle != kClothItself)
            rotation = config_.scene.obstacles[static_cast<std::size_t>(contact.obstacle)]
                           .at(state().time)
                           .placement.rotation;
        ContactReading reading;
        for (std::size_t k = 0; k < reading.vertices.size(); ++k)
            reading.vertices[k] = state().index_of(contact.vertex_ids[k]);
        reading.obstacle = contact.obstacle;
        reading.force = contact.multiplier / at_.gamma * (rotation * contact.normal);
        reading.friction = rotation * contact.friction.force;
        readings.push_back(reading);
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
