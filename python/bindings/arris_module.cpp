// SPDX-License-Identifier: GPL-3.0-or-later
// The extension module arris._arris. The package python/arris gives it its interface and its documentation.
#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <oneapi/tbb/global_control.h>

#include "app/files/csv_table.h"
#include "app/scene/keys/scene_document.h"
#include "app/text/printable.h"
#include "app/text/version.h"
#include "geometry/input_error.h"
#include "geometry/obstacle_input/import_command.h"
#include "geometry/rigid_motion.h"
#include "python/bindings/core.h"
#include "solver/velocity_solve/blas_kernel.h"

namespace py = pybind11;
using namespace arris;

namespace {

void set_threads(int threads)
{
    using tbb::global_control;
    static std::unique_ptr<global_control> control;
    control.reset();
    if (threads > 0)
        control = std::make_unique<global_control>(global_control::max_allowed_parallelism, threads);
}

void translate_errors(py::module_& module)
{
    static py::exception<InputError> input_error(module, "InputError", PyExc_ValueError);
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const InputError& error) {
            input_error(printable(error.what()).c_str());
        } catch (const std::system_error& error) {
            PyErr_SetString(PyExc_OSError, printable(error.what()).c_str());
        }
    });
}

/// Reads an untrusted mesh file, in a process of its own. It ends without running destructors: after a broken
/// file those of the import library are not safe.
void import_obstacle(std::vector<std::string> arguments)
{
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    std::_Exit(import_obstacle_command(static_cast<int>(pointers.size()), pointers.data()));
}

}  // namespace

PYBIND11_MODULE(_arris, module)
{
    translate_errors(module);
    module.attr("version") = kVersion;
    module.def("blas_kernel", blas_kernel);
    module.def("row_header", step_header);
    module.def("read_scene_text", [](const std::string& path) { return read_scene_text(path); });
    module.def("rotation_about", rotation_about);
    module.def("set_threads", set_threads);
    module.def("import_obstacle", import_obstacle);
    py::module_::import("atexit").attr("register")(py::cpp_function(end_steps));

    py::class_<Mover>(module, "Mover");
    py::class_<Core::Stepped>(module, "Stepped")
        .def_readonly("rows", &Core::Stepped::rows)
        .def_readonly("status", &Core::Stepped::status)
        .def_readonly("message", &Core::Stepped::message);
    py::class_<Core>(module, "Core")
        .def(py::init<const std::string&, const std::string&, const std::vector<std::string>&,
                      const std::vector<std::string>&>())
        .def("step", &Core::step)
        .def_property_readonly("time", &Core::time)
        .def_property_readonly("duration", &Core::duration)
        .def_property_readonly("is_over", &Core::is_over)
        .def_property_readonly("positions", &Core::positions)
        .def_property_readonly("velocities", &Core::velocities)
        .def_property_readonly("material", &Core::material)
        .def_property_readonly("material_points", &Core::material_points)
        .def_property_readonly("faces", &Core::faces)
        .def_property_readonly("face_points", &Core::face_points)
        .def_property_readonly("eol", &Core::eol)
        .def("contacts", &Core::contacts)
        .def("energies", &Core::energies)
        .def("probes", &Core::probes)
        .def("pin", &Core::pin)
        .def("obstacle", &Core::obstacle)
        .def("place", &Core::place)
        .def("drive", &Core::drive)
        .def("placement",
             [](const Core& core, const Mover& mover) {
                 const Placement placement = core.placement(mover);
                 return py::make_tuple(placement.rotation, placement.translation);
             })
        .def("save", &Core::save)
        .def("load", [](Core& core, const py::bytes& bytes) { core.load(bytes); })
        .def("write_frame", &Core::write_frame)
        .def_property_readonly("obstacle_names", &Core::obstacle_names)
        .def_property_readonly("warnings", &Core::warnings)
        .def("warnings_at_end", &Core::warnings_at_end)
        .def("scene_as_run", &Core::scene_as_run);
}
