// Binds sinew.view(), which shows a simulation in the browser.
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "errors.hpp"
#include "session.hpp"

#ifdef SINEW_HAS_VIEWER
#include "viewer/browser.hpp"
#include "viewer/follow_source.hpp"
#include "viewer/limits.hpp"
#include "viewer/server.hpp"
#endif

namespace sinew::python {

namespace {

struct ViewOptions {
  bool open_browser = true, paused = false;
  std::string host;
  std::optional<int> port;
  std::optional<double> speed;
};

#ifdef SINEW_HAS_VIEWER

using namespace std::chrono_literals;

/// Name of a controller made in Python.
constexpr const char* kUnnamed = "python";
/// Time between checks for Ctrl-C.
constexpr auto kPause = 50ms;

std::shared_ptr<sim::Simulation> simulation_of(const std::shared_ptr<Session>& session) {
  return {session, &session->simulation()};
}

viewer::ServerSettings server_settings(const ViewOptions& options) {
  viewer::ServerSettings settings{options.host, std::nullopt};
  if (!options.port) return settings;
  if (*options.port < 0 || *options.port > std::numeric_limits<std::uint16_t>::max()) {
    throw Error(ErrorKind::out_of_range, {.item = "view(port)"},
                fmt::format("{} is not a port", *options.port),
                "give 1 to 65535, 0 for any that is free, or None");
  }
  settings.port = static_cast<std::uint16_t>(*options.port);
  return settings;
}

viewer::LiveSettings live_settings(const ViewOptions& options, double usual_speed) {
  const double speed = options.speed.value_or(usual_speed);
  if (!viewer::limits::is_speed(speed)) {
    throw Error(ErrorKind::out_of_range, {.item = "view(speed)"},
                fmt::format("{:g} is out of range", speed),
                "give 0.01 to 100 simulated seconds a second, or 0 for as fast as it can");
  }
  return {{}, !options.paused, speed, {}};
}

void announce(const viewer::Server& server, const ViewOptions& options, const char* more) {
  py::print(fmt::format("the view is at {}{}", server.url(), more), py::arg("flush") = true);
  if (options.open_browser) viewer::open_browser(server.url());
}

/// The current name of the controller, for RobotState.
std::string controller_name(const Session& session) {
  const auto& controller = session.controller();
  if (!controller) return {};
  return controller->name.empty() ? kUnnamed : controller->name;
}

/// The view of a robot that a script steps; see the docstrings.
class View {
 public:
  View(std::shared_ptr<Session> session, const ViewOptions& options)
      : session_(std::move(session)) {
    const Session::Use use(*session_);
    auto source = std::make_unique<viewer::FollowSource>(
        session_->robot().robot, simulation_of(session_), live_settings(options, 0.0));
    source_ = source.get();
    observe();
    server_ = std::make_unique<viewer::Server>(server_settings(options), std::move(source));
    server_->start();
    while (!source_->wait_turn(kPause)) {
    }
    announce(*server_, options, "");
  }
  ~View() { close(); }
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  bool update() {
    if (closed()) return false;
    const Session::Use use(*session_);
    observe();
    source_->hand_over();
    while (true) {
      {
        const py::gil_scoped_release release;
        if (source_->wait_turn(kPause)) break;
      }
      if (PyErr_CheckSignals() == 0) continue;
      server_->stop();  // else the source would continue its turn
      closed_ = true;
      throw py::error_already_set();
    }
    return !source_->ended();
  }

  void close() {
    if (closed_) return;
    closed_ = true;
    server_->stop();
  }
  bool closed() const { return closed_; }
  std::string url() const { return server_->url(); }

 private:
  void observe() {
    const auto& controller = session_->controller();
    source_->observe(controller_name(*session_), controller ? controller->law.get() : nullptr);
  }

  std::shared_ptr<Session> session_;
  std::unique_ptr<viewer::Server> server_;
  viewer::FollowSource* source_ = nullptr;
  bool closed_ = false;
};

// The thread of the page steps the simulation until Ctrl-C. The session then takes its controller
// back.
void drive(const std::shared_ptr<Session>& session, const ViewOptions& options) {
  const Session::Use use(*session);
  const viewer::LiveSettings settings = live_settings(options, 1.0);
  const viewer::ServerSettings where = server_settings(options);
  const std::string name = controller_name(*session);
  std::optional<scene::SceneController> first;
  if (auto lent = session->lend_controller()) first = {name, std::move(*lent)};
  try {
    auto source = std::make_unique<viewer::LiveSource>(session->robot().robot,
                                                       simulation_of(session), first, settings);
    viewer::LiveSource* live = source.get();
    if (options.open_browser) live->await_page();
    viewer::Server server(where, std::move(source));
    server.start();
    const auto notebook = py::module_::import("sinew.notebook");
    ViewOptions once = options;
    if (notebook.attr("show")(server.url()).cast<bool>()) once.open_browser = false;
    announce(server, once, "; Ctrl-C goes on");
    while (PyErr_CheckSignals() == 0) {
      const py::gil_scoped_release release;
      std::this_thread::sleep_for(kPause);
    }
    server.stop();
    auto [last, law] = live->take_controller();
    session->take_back(first && last == first->name, last, std::move(law));
    session->count_steps();
  } catch (...) {
    if (first) {
      session->take_back(true, name,
                         control::make_controller(session->simulation(), first->settings));
    }
    throw;
  }
  if (PyErr_ExceptionMatches(PyExc_KeyboardInterrupt) == 0) throw py::error_already_set();
  PyErr_Clear();
}

#else

[[noreturn]] void without_viewer() {
  throw Error(ErrorKind::tool_missing, {.item = "view()"},
              "this package was built without the view",
              "build it with SINEW_VIEWER=ON; Node.js is needed for that");
}

class View {
 public:
  View(const std::shared_ptr<Session>&, const ViewOptions&) { without_viewer(); }
  bool update() { return false; }
  void close() {}
  bool closed() const { return true; }
  std::string url() const { return {}; }
};

void drive(const std::shared_ptr<Session>&, const ViewOptions&) { without_viewer(); }

#endif

py::object open_view(const std::shared_ptr<Session>& session, bool block, std::optional<int> port,
                     const std::string& host, bool open_browser, bool paused,
                     std::optional<double> speed) {
  const ViewOptions options{open_browser, paused, host, port, speed};
  if (!block) return py::cast(std::make_unique<View>(session, options));
  drive(session, options);
  return py::none();
}

}  // namespace

void bind_view(py::module_& module) {
  py::class_<View>(
      module, "View",
      R"(Live view of a simulation that a script steps, from sinew.view(sim, block=False).

The script steps and calls update(); a `with` statement closes the view at its end. A notebook shows the page in a frame.)")
      .def("update", &View::update,
           R"(update($self)
--

Shows the present state, and applies the user's actions on the page: commands of actuators, targets of the
attached controller, pulling. Returns at once, unless the page has paused the script or limits it to real
time.

Returns
-------
bool
    False when the view is closed.

Raises
------
KeyboardInterrupt
    On Ctrl-C; the view is closed.
)")
      .def("close", &View::close, R"(close($self)
--

Closes the view. The simulation does not change.
)")
      .def_property_readonly("closed", &View::closed, "bool: whether close() was called.")
      .def_property_readonly("url", &View::url, "str: the page's address.")
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](View& self, const py::object&, const py::object&, const py::object&) {
        self.close();
      });
  module.def(
      "view", &open_view, py::arg("sim"), py::kw_only(), py::arg("block") = true,
      py::arg("port") = py::none(), py::arg("host") = "127.0.0.1", py::arg("open_browser") = true,
      py::arg("paused") = false, py::arg("speed") = py::none(),
      R"(view(sim, *, block=True, port=None, host='127.0.0.1', open_browser=True, paused=False, speed=None)
--

Opens a simulation in the browser.

With `block` the page runs the simulation from its present state until Ctrl-C; afterwards it is as the page
left it, including controller and targets. A notebook shows the page below the cell. Without `block` the script
steps the simulation and the page displays it:

    with sinew.view(sim, block=False) as view:
        for pull in np.linspace(0, 0.01, 200):
            sim.actuator("long_0").displacement = pull
            sim.step()
            view.update()

Parameters
----------
sim : Simulation
block : bool
port : int, optional
    0: any free port; by default 8080 or the next free one.
host : str
    Address to listen on. If it is not this machine only ('0.0.0.0'), the printed address carries a token.
open_browser : bool
    Whether to open a browser if there is a display.
paused : bool
    Whether to wait for Play on the page.
speed : float, optional
    Simulated seconds per second, 0 for as fast as possible; by default 1 with `block`, else 0.

Returns
-------
View or None
    None with `block`.

Raises
------
Error
    address-in-use, bad-argument (host), out-of-range, simulation-busy.
)");
}

}  // namespace sinew::python
