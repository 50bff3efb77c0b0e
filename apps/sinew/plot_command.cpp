// sinew plot: pictures of a recorded run, or of a sweep.
#include <filesystem>
#include <memory>
#include <string>

#include "sinew/core/error.hpp"

#include "commands.hpp"
#include "python_tool.hpp"

namespace sinew::cli {

namespace {

struct PlotOptions {
  std::string folder, out, kind;
};

int plot(const PlotOptions& options) {
  const std::filesystem::path folder = options.folder;
  if (std::filesystem::exists(folder / "sweep.h5")) {
    return run_python_module("sinew.plot", {"sweep", folder.string(), options.out, options.kind});
  }
  if (!std::filesystem::exists(folder / "run.csv")) {
    throw Error(ErrorKind::file_not_found, {.file = (folder / "run.csv").string()},
                "there is no recorded run",
                "name the folder that `sinew run` or `sinew sweep` wrote");
  }
  if (!options.kind.empty()) {
    throw Error(ErrorKind::bad_argument, {.item = "--kind"}, "only sweeps have kinds of plots",
                "leave it out for a run");
  }
  const std::string out = options.out.empty() ? (folder / "run.png").string() : options.out;
  return draw_plot({"run", folder.string(), out});
}

}  // namespace

void add_plot(CommandLine& line) {
  Command command =
      line.add_command("plot", "Draw what a run or a sweep recorded, from its folder");
  const auto options = std::make_shared<PlotOptions>();
  command
      .add_option("DIR", options->folder,
                  "Folder of the run or the sweep, as `sinew run` or `sinew sweep` wrote it")
      .required();
  command.add_option("-o,--out", options->out,
                     "PNG file (default: DIR/run.png); of a sweep the folder of several, or with "
                     "--kind the file (default: DIR)");
  command
      .add_option("--kind", options->kind,
                  "Of a sweep only this: scatter, parallel, surface or workspace (default: all)")
      .type_name("KIND");
  command.footer("Example:\n  sinew run examples/trunk/circle.yaml && sinew plot out/circle");
  command.set_action([options] { return plot(*options); });
}

}  // namespace sinew::cli
