// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

#include "app/run/simulation.h"

namespace arris {

/// A simulation as Python holds it. Arrays are views on the current state's memory; when the state goes on,
/// views that still exist keep that memory, and the state continues in a copy of it.
class Core {
  public:
    Core(const std::string& path, const std::string& text, const std::vector<std::string>& overrides,
         const std::vector<std::string>& importer);
    ~Core() { part_with_views(); }
    Core(const Core&) = delete;
    Core& operator=(const Core&) = delete;

    struct Stepped {
        std::vector<std::string> rows;  ///< as in steps.csv
        std::string status, message;    ///< empty, or how the simulation has ended
    };
    /// Without the GIL, but for a look at signals. Where a signal's handler raises: that exception.
    Stepped step();

    double time() const { return idle().state().time; }
    double duration() const { return simulation_.config().duration; }
    bool is_over() const { return idle().is_over(); }

    pybind11::array positions();
    pybind11::array velocities();
    pybind11::array material();
    pybind11::array faces();
    pybind11::array material_points();
    pybind11::array face_points();
    pybind11::array eol() const;
    pybind11::dict contacts() const;
    pybind11::dict energies() const;
    pybind11::dict probes() const;

    /// Throws InputError for a pin or an obstacle that is not there, or that cannot be moved.
    Mover pin(int index) const;
    Mover obstacle(const std::string& name) const;
    void place(const Mover& mover, const Mat3& rotation, const Vec3& translation);
    void drive(const Mover& mover, const Vec3& velocity, const Vec3& angular_velocity, const Vec3& pivot);
    Placement placement(const Mover& mover) const { return idle().placement(mover); }

    pybind11::bytes save() const { return to_bytes(idle().at()); }
    void load(const std::string& bytes);
    void write_frame(const std::string& path) const;

    std::vector<std::string> obstacle_names() const;
    const std::vector<std::string>& warnings() const { return simulation_.config().warnings; }
    /// Warnings of a simulation that has come to its end.
    std::vector<std::string> warnings_at_end() const;
    std::string scene_as_run() const { return simulation_.config().as_run.dump(); }

  private:
    class Busy;
    /// Throws std::runtime_error while a step is in progress.
    void require_idle() const;
    const Simulation& idle() const;

    struct Kept;
    template <class Scalar, class Item>
    pybind11::array view(const std::vector<Item>& items, std::size_t count);
    void part_with_views();

    std::weak_ptr<Kept> views_;
    Simulation simulation_;
    bool is_busy_ = false;  ///< read and written with the GIL held
};

/// Stops all steps in progress, and waits for them: for the end of the process.
void end_steps();

}  // namespace arris
