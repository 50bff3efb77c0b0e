// sinew plot: pictures of a recorded run.
#include <filesystem>
#include <memory>
#include <string>

#include "sinew/core/error.hpp"

#include "commands.hpp"
#include "python_tool.hpp"

namespace sinew::cli {

void add_plot(CommandLine& line) {
  Command command = line.add_command("plot", "Draw what a run recorded, from its folder");
  struct Options {
    std::string folder, out;
  };
  const auto options = std::make_shared<Options>();
  command.add_option("DIR", options->folder, "Folder of the run, as `sinew run` wrote it")
      .required();
  command.add_option("-o,--out", options->out, "PNG file (default: DIR/run.png)");
  command.footer("Example:\n  sinew run examples/trunk/circle.yaml && sinew plot out/circle");
  command.set_action([options] {
    const std::filesystem::path folder = options->folder;
    if (!std::filesystem::exists(folder / "run.csv")) {
      throw Error(ErrorKind::file_not_found, {.file = (folder / "run.csv").string()},
                  "there is no recorded run", "name the folder that `sinew run` wrote");
    }
    const std::string out = options->out.empty() ? (folder / "run.png").string() : options->out;
    return draw_plot({"run", folder.string(), out});
  });
}

}  // namespace sinew::cli
