// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "app/files/csv_table.h"
#include "app/files/frame.h"
#include "app/run/checkpoint.h"
#include "app/run/run_ending.h"
#include "app/run/state_readings.h"
#include "app/run/timeline.h"
#include "app/scene/parts/run_config.h"
#include "geometry/rigid_motion.h"
#include "solver/contact/audit.h"
#include "solver/energy_balance.h"
#include "solver/model/step_report.h"
#include "solver/model/stopwatch.h"
#include "solver/workspace.h"

namespace arris {

/// A contact that presses.
struct ContactReading {
    std::array<int, 4> vertices;  ///< of the cloth, -1 where there are fewer
    int obstacle;                 ///< index in the scene, or kClothItself
    Vec3 force;     ///< N, on the first of the cloth's two parts, or on the cloth: along the normal
    Vec3 friction;  ///< N, likewise: across it
};

/// The checkpoint of time 0 of a scene that `load_scene` has made of `source`, or of its assembly.
Checkpoint start_checkpoint(const RunConfig& config, SceneSource source);

/// A scene being simulated: what `arris run`, `arris resume` and the Python module step through. It writes
/// nothing. Each step gives rows (StepRow), as steps.csv has them.
class Simulation {
  public:
    /// Takes up a row after the cloth has come to its time.
    using OnRow = std::function<void(StepRow& row)>;

    /// `at` must belong to the scene of `config` (start_checkpoint, load_resumed).
    Simulation(RunConfig config, Checkpoint at);

    const RunConfig& config() const { return config_; }
    const Checkpoint& at() const { return at_; }
    const State& state() const { return at_.state; }
    const Timeline& timeline() const { return timeline_; }
    bool is_over() const { return timeline_.is_over(at_.position) || is_sewn(); }

    /// How cloth that is being sewn ends whose time is up; none of any other.
    std::optional<RunEnding> find_unsewn() const;

    /// Time, s, at which it is over; of cloth that is being sewn, if the seams of this order are the last,
    /// and nothing holds them back.
    double expected_end() const;
    bool is_sewn() const;  ///< as an assembly ends

    /// Gives the row of time 0. `seconds`: of loading.
    void tell_start(double seconds, const OnRow& on_row);

    /// Makes one planned step, with a row for each part; an opening has no row of its own. Returns how the
    /// simulation ends where the step failed, or where `settings.is_interrupted` says so: the step is then as
    /// if never begun.
    std::optional<RunEnding> step(const OnRow& on_row);

    /// Asked in each solve whether to stop.
    void watch(bool (*is_interrupted)()) { config_.settings.is_interrupted = is_interrupted; }

    /// Moves a pin or an obstacle to a placement at the end of the next step, where it then stays; until then
    /// as between two keyframes. It must neither follow another obstacle nor deform.
    void place(const Mover& mover, const Placement& to);

    /// Moves it from the current time on with these velocities (m/s, rad/s) about `pivot` (m, world), which
    /// moves along.
    void drive(const Mover& mover, const Vec3& velocity, const Vec3& angular_velocity, const Vec3& pivot);

    /// The current placement of the frame of a pin or an obstacle.
    Placement placement(const Mover& mover) const;

    /// Goes to a checkpoint of this scene.
    void go_to(Checkpoint at);

    /// Goes on with a copy of the state, and returns the arrays that it has had so far: of views on them.
    State part_with_state();

    /// The contacts that press, with forces in N, in the world.
    std::vector<ContactReading> contacts() const;

    /// Readings of the current state.
    Frame frame() const;
    std::vector<ProbeSample> probes() const { return sample_probes(config_.probes, state()); }
    ClothEnergy energy() const { return find_energy(config_.scene, state(), work_); }

    /// Wall time since the last row, s: of a step that was cut off or failed.
    double seconds_since_row() { return since_row_.lap(); }

  private:
    void write_row(const StepReport& report, bool is_halved, const OnRow& on_row);
    GivenMotion& given(const Mover& mover);
    void set_keyframes(GivenMotion& given, const Placement& to);
    Vec3 pivot_of(const GivenMotion& given) const;
    Placement driven_placement(const GivenMotion& given) const;
    Vec3 driven_velocity(const GivenMotion& given, const Vec3& place) const;
    bool move_on_given();
    void apply(const GivenMotion& given);
    void apply_given();

    RunConfig config_;
    std::vector<Pin> pins_;                  ///< of the scene, before any was moved on
    std::vector<MovingObstacle> obstacles_;  ///< likewise
    Timeline timeline_;
    Checkpoint at_;
    Workspace work_;
    Audit audited_;                      ///< of the current cloth, if the time is that of a frame or the end
    SelfCrossings crossed_;              ///< likewise
    Stopwatch since_row_;                ///< wall time since the last row
    std::optional<StepReport> opening_;  ///< first part of the current step, not yet given as a row
};

}  // namespace arris
