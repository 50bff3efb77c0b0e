// sinew plot: plots a recorded run or a sweep.
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
                "no recorded run here", "give the output folder of `sinew run` or `sinew sweep`");
  }
  if (!options.kind.empty()) {
    throw Error(ErrorKind::bad_argument, {.item = "--kind"}, "--kind applies to sweeps only",
                "omit it for a run");
  }
  const std::string out = options.out.empty() ? (folder / "run.png").string() : options.out;
  return draw_plot({"run", folder.string(), out});
}

}  // namespace

void add_plot(CommandLine& line) {
  Command command = line.add_command("plot", "Plot a recorded run or a sweep");
  const auto options = std::make_shared<PlotOptions>();
  command.add_option("DIR", options->folder, "Output folder of `sinew run` or `sinew sweep`")
      .required();
  command
      .add_option("-o,--out", options->out,
                  "PNG file (default: DIR/run.png); for a sweep, a folder (default: DIR), or a "
                  "file with --kind")
      .type_name("PATH");
  command
      .add_option("--kind", options->kind,
                  "Plot of a sweep: scatter, parallel, surface or workspace (default: all four)")
      .type_name("KIND");
  command.footer("Example:\n  sinew run examples/trunk/circle.yaml && sinew plot out/circle");
  command.set_action([options] { return plot(*options); });
}

}  // namespace sinew::cli
