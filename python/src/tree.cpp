#include "tree.hpp"

#include <string>

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include "sinew/core/error.hpp"

namespace sinew::python {

namespace {

namespace py = pybind11;
using scene::Node;

constexpr int kDeepest = 32;

Node convert(const py::handle& value, const std::string& path, int depth);

Node to_map(const py::handle& value, const std::string& path, int depth) {
  Node map = Node::map();
  for (const auto& item : py::list(value.attr("items")())) {
    const auto pair = py::reinterpret_borrow<py::tuple>(item);
    if (!py::isinstance<py::str>(pair[0])) {
      throw Error(ErrorKind::wrong_type, {.item = path.empty() ? "scene" : path},
                  fmt::format("the key {} is not text", std::string(py::repr(pair[0]))),
                  "name every entry by text");
    }
    const std::string key = py::str(pair[0]);
    map.set(key, convert(pair[1], path.empty() ? key : fmt::format("{}.{}", path, key), depth + 1));
  }
  return map;
}

Node to_items(const py::handle& value, const std::string& path, int depth) {
  Node list = Node::list();
  std::size_t index = 0;
  for (const auto& item : value) {
    list.append(convert(item, fmt::format("{}[{}]", path, index++), depth + 1));
  }
  return list;
}

Node convert(const py::handle& value, const std::string& path, int depth) {
  if (depth > kDeepest) {
    throw Error(ErrorKind::size_limit, {.item = path.substr(0, 60)},
                fmt::format("the scene is nested more than {} levels deep", kDeepest),
                "a dict must not hold itself");
  }
  if (value.is_none()) return Node();
  if (PyBool_Check(value.ptr())) return Node::boolean(value.ptr() == Py_True);
  if (py::isinstance<py::str>(value)) return Node::text(py::str(value));
  if (py::isinstance<py::dict>(value) || py::hasattr(value, "items")) {
    return to_map(value, path, depth);
  }
  // NumPy scalars and arrays become Python numbers and lists.
  if (py::hasattr(value, "tolist")) return convert(value.attr("tolist")(), path, depth + 1);
  if (PyLong_Check(value.ptr())) {
    int overflow = 0;
    const long long number = PyLong_AsLongLongAndOverflow(value.ptr(), &overflow);
    return overflow == 0 ? Node::integer(number) : Node::plain(py::str(value));
  }
  if (PyFloat_Check(value.ptr())) {
    const double number = value.cast<double>();
    if (!std::isfinite(number)) {
      throw Error(ErrorKind::not_finite, {.item = path}, fmt::format("the value is {}", number),
                  "give a finite number, or leave the key out");
    }
    return Node::number(number);
  }
  if (py::hasattr(value, "__fspath__")) return Node::text(py::str(value.attr("__fspath__")()));
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    return to_items(value, path, depth);
  }
  throw Error(ErrorKind::wrong_type, {.item = path},
              fmt::format("a value of type {} has no place in a scene",
                          std::string(py::str(py::type::handle_of(value).attr("__name__")))),
              "use dicts, lists, numbers and text");
}

}  // namespace

Node to_tree(const py::handle& value) { return convert(value, "", 0); }

}  // namespace sinew::python
