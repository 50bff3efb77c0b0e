#include "errors.hpp"

#include <string>

namespace sinew::python {

namespace {

py::object to_python(const Location& place) {
  return py::module_::import("sinew.errors")
      .attr("Location")(place.file, place.line, place.column, place.item);
}

py::object make(const char* type, std::string_view kind, const Location& place,
                const std::string& message, const std::string& remedy) {
  return py::module_::import("sinew.errors")
      .attr(type)(std::string(kind), to_python(place), message, remedy);
}

void raise(const py::object& error) { PyErr_SetObject(py::type::of(error).ptr(), error.ptr()); }

}  // namespace

py::object to_python(const Error& error) {
  return make(error.is_run_failure() ? "RunError" : "Error", error_kind_name(error.kind()),
              error.place(), error.message(), error.remedy());
}

py::object to_python(const Notice& notice) {
  return py::module_::import("sinew.errors")
      .attr("Notice")(std::string(notice_level_name(notice.level)),
                      std::string(notice_kind_name(notice.kind)), to_python(notice.place),
                      notice.message, notice.remedy);
}

void register_errors() {
  py::register_local_exception_translator(
      [](std::exception_ptr pointer) {  // NOLINT(performance-unnecessary-value-param): pybind11
        try {
          if (pointer) std::rethrow_exception(pointer);
        } catch (const Error& error) {
          raise(to_python(error));
        } catch (const SimulationBusy&) {
          raise(make("Error", "simulation-busy", {.item = "simulation"},
                     "another thread is using this simulation",
                     "give every thread its own: sim.clone() shares the model"));
        }
      });
}

}  // namespace sinew::python
