#include "sinew/record/run_file.hpp"

#include <algorithm>
#include <array>
#include <fstream>

#include <fmt/format.h>

#include "sinew/record/hdf5_reader.hpp"
#include "sinew/record/run_recorder.hpp"

namespace sinew::record {

namespace {

constexpr std::uint64_t kMaxFrames = std::uint64_t{1} << 28;

void require_known(const std::string& file, const std::vector<std::string>& known,
                   std::string_view name) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  const std::string nearest = nearest_word(name, known);
  throw Error(ErrorKind::unknown_name, {.file = file}, fmt::format("the run has no '{}'", name),
              nearest.empty() ? fmt::format("it has {}", fmt::join(known, ", "))
                              : fmt::format("did you mean '{}'?", nearest));
}

}  // namespace

struct RunFile::Content {
  explicit Content(const std::filesystem::path& path) : file(path) {
    if (file.text_attribute("format") != "sinew-run") {
      throw Error(ErrorKind::unknown_format, {.file = file.path()},
                  "this HDF5 file does not hold a run", "give a run.h5 that 'sinew run' wrote");
    }
    format = file.integer_attribute("format_version");
    if (format < kOldestRunFormatVersion || format > kRunFormatVersion) {
      throw Error(ErrorKind::unsupported_version, {.file = file.path()},
                  fmt::format("the record has format {}, this program reads {} to {}", format,
                              kOldestRunFormatVersion, kRunFormatVersion),
                  "use the version of Sinew that wrote it, or record the run again");
    }
    version = file.text_attribute("sinew_version");
    name = file.text_attribute("scene_name");
    scene = file.text("/scene");
    time_step = file.number_attribute("time_step");
    bodies = file.names("/mesh");
    actuators = file.names("/actuators");
    effectors = file.names("/effectors");
    if (file.has("/probes")) probes = file.names("/probes");
    if (file.has("/contacts")) contacts = file.names("/contacts");
    states = file.has("/positions");
    datasets = file.datasets("/");
    std::erase_if(datasets, [](const std::string& one) { return one.starts_with("/mesh/"); });
    frames = complete_frames();
    times = file.rows("/time", 0, frames);
  }

  // An interrupted run may have ended between two series of a frame.
  std::uint64_t complete_frames() const {
    std::uint64_t least = kMaxFrames;
    const auto count = [&](const std::string& series) {
      const Hdf5Reader::Shape shape = file.shape(series);
      if (shape.empty()) file.fail(fmt::format("{} is not a series", series));
      least = std::min(least, shape[0]);
    };
    count("/time");
    for (const std::string& series : datasets) count(series);
    return least;
  }

  Hdf5Reader file;
  std::string version, name, scene;
  std::int64_t format = 0;
  double time_step = 0.0;
  std::uint64_t frames = 0;
  bool states = false;
  std::vector<double> times;
  std::vector<std::string> bodies, actuators, effectors, probes, contacts, datasets;
};

RunFile::RunFile(const std::filesystem::path& path) : content_(std::make_unique<Content>(path)) {}
RunFile::~RunFile() = default;
RunFile::RunFile(RunFile&&) noexcept = default;
RunFile& RunFile::operator=(RunFile&&) noexcept = default;

bool RunFile::is_hdf5(const std::filesystem::path& path) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  std::array<char, 8> start{};
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), start.size());
  return file.good() && std::string_view(start.data(), start.size()) == signature;
}

std::int64_t RunFile::format_version() const { return content_->format; }

std::string RunFile::lacks() const {
  if (content_->format == kRunFormatVersion) return {};
  return fmt::format("recorded without commands, energies and resultants of contacts (format {})",
                     content_->format);
}

const std::string& RunFile::sinew_version() const { return content_->version; }
const std::string& RunFile::scene_name() const { return content_->name; }
const std::string& RunFile::scene() const { return content_->scene; }
double RunFile::time_step() const { return content_->time_step; }
std::int64_t RunFile::frames() const { return static_cast<std::int64_t>(content_->frames); }
const std::vector<double>& RunFile::times() const { return content_->times; }
const std::vector<std::string>& RunFile::bodies() const { return content_->bodies; }
const std::vector<std::string>& RunFile::actuators() const { return content_->actuators; }
const std::vector<std::string>& RunFile::effectors() const { return content_->effectors; }
const std::vector<std::string>& RunFile::probes() const { return content_->probes; }
const std::vector<std::string>& RunFile::contacts() const { return content_->contacts; }
bool RunFile::has_states() const { return content_->states; }

mesh::Mesh RunFile::rest_mesh(std::string_view body) const {
  const Hdf5Reader& file = content_->file;
  require_known(file.path(), content_->bodies, body);
  const std::string folder = "/mesh/" + std::string(body);
  const auto nodes = file.shape(folder + "/nodes");
  if (nodes.size() != 2) file.fail(folder + " holds no mesh");
  const std::vector<double> numbers = file.numbers(folder + "/nodes", {nodes[0], 3});
  mesh::Mesh mesh;
  mesh.name = file.path() + ": " + std::string(body);
  mesh.nodes = Eigen::Map<const Points>(numbers.data(), static_cast<Eigen::Index>(nodes[0]), 3);
  const auto read = [&](const char* kind, auto& list) {
    constexpr std::size_t kCorners = std::tuple_size_v<std::decay_t<decltype(list[0])>>;
    const auto shape = file.shape(folder + kind);
    if (shape.size() != 2) file.fail(folder + " holds no mesh");
    const std::vector<std::int32_t> corners = file.integers(folder + kind, {shape[0], kCorners});
    list.resize(shape[0]);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (corners[i] < 0 || static_cast<std::uint64_t>(corners[i]) >= nodes[0]) {
        file.fail(fmt::format("{} has node {} of {}", folder, corners[i], nodes[0]));
      }
      list[i / kCorners][i % kCorners] = corners[i];
    }
  };
  read("/tetrahedra", mesh.tetrahedra);
  read("/hexahedra", mesh.hexahedra);
  if (file.has(folder + "/quadratic")) {
    read("/quadratic", mesh.quadratic);
    if (mesh.quadratic.size() != mesh.tetrahedra.size()) {
      file.fail(folder + " has quadratic tetrahedra without their corners");
    }
  }
  return mesh;
}

void RunFile::require_state(std::string_view body, std::int64_t frame) const {
  const Hdf5Reader& file = content_->file;
  require_known(file.path(), content_->bodies, body);
  if (!content_->states) {
    throw Error(ErrorKind::missing_key, {.file = file.path()},
                "the run was recorded without states",
                "write record: {states: true} in the scene and run it again");
  }
  require_frame(frame);
}

void RunFile::require_frame(std::int64_t frame) const {
  if (frame < 0 || frame >= frames()) {
    throw Error(ErrorKind::out_of_range, {.file = content_->file.path()},
                fmt::format("there is no frame {}", frame),
                fmt::format("the frames are 0 to {}", frames() - 1));
  }
}

Points RunFile::positions(std::string_view body, std::int64_t frame) const {
  require_state(body, frame);
  const Hdf5Reader& file = content_->file;
  const std::string name = "/positions/" + std::string(body);
  const auto shape = file.shape(name);
  if (shape.size() != 3 || shape[2] != 3) file.fail(name + " holds no positions");
  const std::vector<double> numbers = file.rows(name, static_cast<std::uint64_t>(frame), 1);
  return Eigen::Map<const Points>(numbers.data(), static_cast<Eigen::Index>(shape[1]), 3);
}

std::vector<double> RunFile::actuator(std::string_view actuator, std::string_view what) const {
  const Hdf5Reader& file = content_->file;
  require_known(file.path(), content_->actuators, actuator);
  const std::string name = fmt::format("/actuators/{}/{}", actuator, what);
  if (what.ends_with("_command") && content_->format < kRunFormatVersion) {
    throw Error(ErrorKind::missing_key, {.file = file.path()}, "the run was " + lacks(),
                "run its scene again: sinew run");
  }
  if (file.shape(name).size() != 1) file.fail(name + " is not a series of numbers");
  return series(name);
}

const std::vector<std::string>& RunFile::datasets() const { return content_->datasets; }

bool RunFile::has(const std::string& dataset) const { return content_->file.has(dataset); }

std::vector<double> RunFile::series(const std::string& dataset) const {
  return content_->file.rows(dataset, 0, content_->frames);
}

std::vector<double> RunFile::numbers(const std::string& dataset, std::int64_t frame) const {
  require_frame(frame);
  return content_->file.rows(dataset, static_cast<std::uint64_t>(frame), 1);
}

Points RunFile::effector(std::string_view effector) const {
  const Hdf5Reader& file = content_->file;
  require_known(file.path(), content_->effectors, effector);
  const std::string name = fmt::format("/effectors/{}/position", effector);
  const auto shape = file.shape(name);
  if (shape.size() != 2 || shape[1] != 3) file.fail(name + " holds no positions");
  const std::vector<double> numbers = file.rows(name, 0, content_->frames);
  return Eigen::Map<const Points>(numbers.data(), static_cast<Eigen::Index>(content_->frames), 3);
}

std::vector<double> RunFile::probe(std::string_view probe) const {
  const Hdf5Reader& file = content_->file;
  require_known(file.path(), content_->probes, probe);
  return file.rows(fmt::format("/probes/{}/value", probe), 0, content_->frames);
}

}  // namespace sinew::record
