#include "sinew/record/hdf5_file.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <hdf5.h>

#include "sinew/core/error.hpp"

namespace sinew::record {

namespace {

// An HDF5 identifier with the function that closes it.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  bool valid() const { return id_ >= 0; }
  operator hid_t() const { return id_; }  // NOLINT: HDF5's functions take identifiers

 private:
  hid_t id_;
  Close close_;
};

// HDF5 prints its own stack of errors unless told not to.
void be_quiet() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw Error(ErrorKind::recording_failed, {.file = path}, what,
              "check that the disk has space left");
}

std::vector<hsize_t> dimensions(const std::vector<std::size_t>& shape) {
  return {shape.begin(), shape.end()};
}

Handle intermediate_groups() {
  Handle list(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(list, 1);
  return list;
}

}  // namespace

struct Hdf5Writer::File {
  struct Array {
    Handle set;
    std::vector<hsize_t> frame;
    hsize_t count = 0;
  };

  explicit File(const std::filesystem::path& path_in)
      : path(path_in.string()),
        id(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose) {}

  std::string path;
  Handle id;
  std::vector<Array> arrays;

  void write_array(const std::string& name, const std::vector<std::size_t>& shape, hid_t type,
                   const void* values) {
    const auto extent = dimensions(shape);
    const Handle space(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr),
                       H5Sclose);
    const Handle set(
        H5Dcreate2(id, name.c_str(), type, space, intermediate_groups(), H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    if (!set.valid() || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
      fail(path, fmt::format("cannot write {}", name));
    }
  }
};

Hdf5Writer::Hdf5Writer(const std::filesystem::path& path) {
  be_quiet();
  file_ = std::make_unique<File>(path);
  if (!file_->id.valid()) {
    throw Error(ErrorKind::file_unwritable, {.file = path.string()}, "cannot create the file",
                "check that the folder exists and may be written to");
  }
}

Hdf5Writer::~Hdf5Writer() = default;
Hdf5Writer::Hdf5Writer(Hdf5Writer&&) noexcept = default;
Hdf5Writer& Hdf5Writer::operator=(Hdf5Writer&&) noexcept = default;

void Hdf5Writer::text_attribute(const std::string& name, const std::string& value) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(value.size(), 1));
  H5Tset_cset(type, H5T_CSET_UTF8);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  // Attributes over 64 KiB do not fit an object header; long texts are arrays of their own.
  if (value.size() > 60000) {
    const Handle set(H5Dcreate2(file_->id, ("/" + name).c_str(), type, space, H5P_DEFAULT,
                                H5P_DEFAULT, H5P_DEFAULT),
                     H5Dclose);
    if (!set.valid() || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value.c_str()) < 0) {
      fail(file_->path, fmt::format("cannot write {}", name));
    }
    return;
  }
  const Handle attribute(H5Acreate2(file_->id, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute, type, value.c_str()) < 0) {
    fail(file_->path, fmt::format("cannot write {}", name));
  }
}

void Hdf5Writer::number_attribute(const std::string& name, double value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(
      H5Acreate2(file_->id, name.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) < 0) {
    fail(file_->path, fmt::format("cannot write {}", name));
  }
}

void Hdf5Writer::array(const std::string& path, const std::vector<std::size_t>& shape,
                       std::span<const double> values) {
  file_->write_array(path, shape, H5T_NATIVE_DOUBLE, values.data());
}

void Hdf5Writer::array(const std::string& path, const std::vector<std::size_t>& shape,
                       std::span<const std::int32_t> values) {
  file_->write_array(path, shape, H5T_NATIVE_INT32, values.data());
}

int Hdf5Writer::growing(const std::string& path, const std::vector<std::size_t>& frame_shape,
                        const std::string& unit) {
  std::vector<hsize_t> extent = dimensions(frame_shape);
  std::vector<hsize_t> frame = extent;
  hsize_t size = 1;
  for (const hsize_t n : frame) size *= n;
  extent.insert(extent.begin(), 0);
  std::vector<hsize_t> limits = extent;
  limits[0] = H5S_UNLIMITED;
  std::vector<hsize_t> chunk = extent;
  chunk[0] = std::clamp<hsize_t>(8192 / std::max<hsize_t>(size, 1), 1, 1024);
  const Handle space(
      H5Screate_simple(static_cast<int>(extent.size()), extent.data(), limits.data()), H5Sclose);
  const Handle list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(list, static_cast<int>(chunk.size()), chunk.data());
  H5Pset_shuffle(list);
  H5Pset_deflate(list, 1);
  Handle set(H5Dcreate2(file_->id, path.c_str(), H5T_NATIVE_DOUBLE, space, intermediate_groups(),
                        list, H5P_DEFAULT),
             H5Dclose);
  if (!set.valid()) fail(file_->path, fmt::format("cannot create {}", path));
  if (!unit.empty()) {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, unit.size());
    const Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(set, "unit", type, scalar, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    H5Awrite(attribute, type, unit.c_str());
  }
  file_->arrays.push_back({std::move(set), std::move(frame), 0});
  return static_cast<int>(file_->arrays.size()) - 1;
}

void Hdf5Writer::append(int array, std::span<const double> frame) {
  auto& into = file_->arrays[static_cast<std::size_t>(array)];
  std::vector<hsize_t> extent = into.frame;
  extent.insert(extent.begin(), into.count + 1);
  std::vector<hsize_t> start(extent.size(), 0);
  start[0] = into.count;
  std::vector<hsize_t> count = extent;
  count[0] = 1;
  const bool grown = H5Dset_extent(into.set, extent.data()) >= 0;
  const Handle file_space(H5Dget_space(into.set), H5Sclose);
  H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  const Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr),
                      H5Sclose);
  if (!grown ||
      H5Dwrite(into.set, H5T_NATIVE_DOUBLE, memory, file_space, H5P_DEFAULT, frame.data()) < 0) {
    fail(file_->path, "cannot append a frame");
  }
  ++into.count;
}

void Hdf5Writer::flush() {
  if (H5Fflush(file_->id, H5F_SCOPE_GLOBAL) < 0) fail(file_->path, "cannot flush the file");
}

namespace {

std::string read_text(hid_t file, const char* name) {
  std::string text;
  if (H5Aexists(file, name) > 0) {
    const Handle attribute(H5Aopen(file, name, H5P_DEFAULT), H5Aclose);
    const Handle type(H5Aget_type(attribute), H5Tclose);
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) return text;
    text.resize(H5Tget_size(type));
    if (H5Aread(attribute, type, text.data()) < 0) text.clear();
  } else if (H5Lexists(file, name, H5P_DEFAULT) > 0) {
    const Handle set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
    const Handle type(H5Dget_type(set), H5Tclose);
    if (!set.valid() || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0)
      return text;
    text.resize(H5Tget_size(type));
    if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) text.clear();
  }
  return text;
}

std::vector<std::string> members(hid_t file, const char* group_name) {
  std::vector<std::string> names;
  if (H5Lexists(file, group_name, H5P_DEFAULT) <= 0) return names;
  const Handle group(H5Gopen2(file, group_name, H5P_DEFAULT), H5Gclose);
  H5G_info_t info;
  if (!group.valid() || H5Gget_info(group, &info) < 0) return names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    char name[256];
    const auto length = H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, name,
                                           sizeof name, H5P_DEFAULT);
    if (length > 0) names.emplace_back(name);
  }
  return names;
}

}  // namespace

RunSummary read_run_summary(const std::filesystem::path& path) {
  be_quiet();
  if (!std::filesystem::exists(path)) {
    throw Error(ErrorKind::file_not_found, {.file = path.string()}, "there is no such file",
                "check the path");
  }
  const auto broken = [&](const char* what) {
    return Error(ErrorKind::malformed_file, {.file = path.string()}, what,
                 "give a run.h5 written by `sinew run`");
  };
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.valid()) throw broken("this is no readable HDF5 file");
  RunSummary summary;
  summary.version = read_text(file, "sinew_version");
  if (summary.version.empty()) throw broken("this HDF5 file does not hold a run");
  summary.scene = read_text(file, "scene");
  summary.bodies = members(file, "/mesh");
  summary.actuators = members(file, "/actuators");
  summary.effectors = members(file, "/effectors");
  if (H5Lexists(file, "time", H5P_DEFAULT) <= 0) throw broken("the run has no time");
  const Handle time(H5Dopen2(file, "time", H5P_DEFAULT), H5Dclose);
  const Handle space(H5Dget_space(time), H5Sclose);
  if (!time.valid() || H5Sget_simple_extent_ndims(space) != 1) throw broken("time is not a list");
  hsize_t frames = 0;
  H5Sget_simple_extent_dims(space, &frames, nullptr);
  summary.frames = frames;
  for (const bool last : {false, true}) {
    if (frames == 0) break;
    const hsize_t at = last ? frames - 1 : 0;
    const hsize_t one = 1;
    H5Sselect_hyperslab(space, H5S_SELECT_SET, &at, nullptr, &one, nullptr);
    const Handle memory(H5Screate_simple(1, &one, nullptr), H5Sclose);
    double value = 0.0;
    if (H5Dread(time, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, &value) < 0) {
      throw broken("the times cannot be read");
    }
    (last ? summary.last_time : summary.first_time) = value;
  }
  return summary;
}

}  // namespace sinew::record
