#include "sinew/record/hdf5_reader.hpp"

#include <array>
#include <cstring>
#include <functional>
#include <utility>

#include <fmt/format.h>

namespace sinew::record {

namespace {

constexpr std::uint64_t kMaxNumbers = std::uint64_t{1} << 31;  // in one read
constexpr std::size_t kMaxText = std::size_t{16} << 20;
constexpr hsize_t kMaxNames = 1u << 20;

// Whether the stored type is of this kind, with at most 8 bytes. A damaged type could grow on
// conversion.
bool is_stored_as(hid_t dataset, H5T_class_t kind) {
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  return H5Tget_class(type.id()) == kind && H5Tget_size(type.id()) <= 8;
}

}  // namespace

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path, Hdf5Remedies remedies)
    : path_(path.string()), remedies_(std::move(remedies)) {
  const QuietHdf5 quiet;
  std::error_code problem;
  if (!std::filesystem::exists(path, problem)) {
    throw Error(ErrorKind::file_not_found, {.file = path_}, "there is no such file",
                "check the path");
  }
  file_ = Hdf5Handle(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (file_.valid()) return;
  throw Error(ErrorKind::unknown_format, {.file = path_},
              fmt::format("this cannot be opened as HDF5: {}", hdf5_reason()), remedies_.unknown);
}

void Hdf5Reader::fail(const std::string& what) const {
  throw Error(ErrorKind::malformed_file, {.file = path_}, what, remedies_.malformed);
}

bool Hdf5Reader::has(const std::string& object) const {
  const QuietHdf5 quiet;
  for (std::size_t end = object.find('/', 1);; end = object.find('/', end + 1)) {
    if (H5Lexists(file_.id(), object.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

std::vector<std::string> Hdf5Reader::names(const std::string& group) const {
  std::vector<std::string> found;
  if (!has(group)) return found;
  const QuietHdf5 quiet;
  const Hdf5Handle opened(H5Gopen2(file_.id(), group.c_str(), H5P_DEFAULT), H5Gclose);
  H5G_info_t info;
  if (!opened.valid() || H5Gget_info(opened.id(), &info) < 0 || info.nlinks > kMaxNames) {
    fail(fmt::format("{} cannot be listed", group));
  }
  std::array<char, 256> name{};
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    if (H5Lget_name_by_idx(opened.id(), ".", H5_INDEX_NAME, H5_ITER_INC, i, name.data(),
                           name.size(), H5P_DEFAULT) > 0) {
      found.emplace_back(name.data());
    }
  }
  return found;
}

std::vector<std::string> Hdf5Reader::datasets(const std::string& group) const {
  constexpr int kDeepest = 8;  // a damaged file may hold a group that is within itself
  std::vector<std::string> found;
  const std::function<void(const std::string&, int)> look = [&](const std::string& folder,
                                                                int depth) {
    if (depth > kDeepest) fail(fmt::format("{} is too deep", folder));
    for (const std::string& name : names(folder)) {
      const std::string path = (folder == "/" ? "" : folder) + "/" + name;
      const QuietHdf5 quiet;
      const Hdf5Handle object(H5Oopen(file_.id(), path.c_str(), H5P_DEFAULT), H5Oclose);
      const H5I_type_t kind = object.valid() ? H5Iget_type(object.id()) : H5I_BADID;
      if (kind == H5I_GROUP) {
        look(path, depth + 1);
      } else if (kind != H5I_DATASET) {
        fail(fmt::format("{} cannot be opened", path));
      } else if (is_stored_as(object.id(), H5T_FLOAT) || is_stored_as(object.id(), H5T_INTEGER)) {
        found.push_back(path);
      }
      if (found.size() > kMaxNames) fail("it has too many datasets");
    }
  };
  look(group, 0);
  return found;
}

void Hdf5Reader::read_attribute(const std::string& name, hid_t type, H5T_class_t kind,
                                void* value) const {
  const QuietHdf5 quiet;
  const Hdf5Handle attribute(H5Aopen(file_.id(), name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) fail(fmt::format("the attribute {} is missing", name));
  const Hdf5Handle stored(H5Aget_type(attribute.id()), H5Tclose);
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (H5Tget_class(stored.id()) != kind || H5Sget_simple_extent_npoints(space.id()) != 1 ||
      H5Aread(attribute.id(), type, value) < 0) {
    fail(fmt::format("the attribute {} cannot be read", name));
  }
}

std::int64_t Hdf5Reader::integer_attribute(const std::string& name) const {
  std::int64_t value = 0;
  read_attribute(name, H5T_NATIVE_INT64, H5T_INTEGER, &value);
  return value;
}

double Hdf5Reader::number_attribute(const std::string& name) const {
  double value = 0.0;
  read_attribute(name, H5T_NATIVE_DOUBLE, H5T_FLOAT, &value);
  return value;
}

std::string Hdf5Reader::text_attribute(const std::string& name) const {
  const QuietHdf5 quiet;
  if (H5Aexists(file_.id(), name.c_str()) <= 0) return {};
  const Hdf5Handle attribute(H5Aopen(file_.id(), name.c_str(), H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) <= 0 ||
      H5Sget_simple_extent_npoints(space.id()) != 1) {
    return {};
  }
  char* found = nullptr;
  if (H5Aread(attribute.id(), type.id(), &found) < 0 || found == nullptr) return {};
  std::string text(found, strnlen(found, kMaxText));
  H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, &found);
  return text;
}

Hdf5Handle Hdf5Reader::open(const std::string& dataset) const {
  if (!has(dataset)) fail(fmt::format("{} is missing", dataset));
  Hdf5Handle opened(H5Dopen2(file_.id(), dataset.c_str(), H5P_DEFAULT), H5Dclose);
  if (!opened.valid()) fail(fmt::format("{} is not an array", dataset));
  return opened;
}

Hdf5Reader::Shape Hdf5Reader::shape(const std::string& dataset) const {
  const QuietHdf5 quiet;
  const Hdf5Handle opened = open(dataset);
  const Hdf5Handle space(H5Dget_space(opened.id()), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.id());
  if (rank < 0 || rank > 8) fail(fmt::format("{} has no extent", dataset));
  std::vector<hsize_t> extent(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.id(), extent.data(), nullptr);
  return {extent.begin(), extent.end()};
}

std::uint64_t Hdf5Reader::volume(const std::string& dataset, const Shape& shape) const {
  std::uint64_t count = 1;
  for (const std::uint64_t size : shape) {
    if (size != 0 && count > kMaxNumbers / size) fail(fmt::format("{} is too large", dataset));
    count *= size;
  }
  return count;
}

std::string Hdf5Reader::text(const std::string& dataset) const {
  const QuietHdf5 quiet;
  const Hdf5Handle opened = open(dataset);
  const Hdf5Handle type(H5Dget_type(opened.id()), H5Tclose);
  const Hdf5Handle space(H5Dget_space(opened.id()), H5Sclose);
  if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) != 0 ||
      H5Sget_simple_extent_npoints(space.id()) != 1 || H5Tget_size(type.id()) > kMaxText) {
    fail(fmt::format("{} is not text", dataset));
  }
  std::string text(H5Tget_size(type.id()), '\0');
  if (H5Dread(opened.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) {
    fail(fmt::format("{} cannot be read: {}", dataset, hdf5_reason()));
  }
  return text.substr(0, text.find('\0'));
}

std::vector<double> Hdf5Reader::numbers(const std::string& dataset, const Shape& expected) const {
  if (shape(dataset) != expected) fail(fmt::format("{} has another size than it must", dataset));
  return expected.empty() ? std::vector<double>() : rows(dataset, 0, expected[0]);
}

std::vector<std::int32_t> Hdf5Reader::integers(const std::string& dataset,
                                               const Shape& expected) const {
  if (shape(dataset) != expected) fail(fmt::format("{} has another size than it must", dataset));
  const QuietHdf5 quiet;
  const std::uint64_t count = volume(dataset, expected);
  const Hdf5Handle opened = open(dataset);
  std::vector<std::int32_t> values;
  if (!is_stored_as(opened.id(), H5T_INTEGER) || H5Dget_storage_size(opened.id()) < count) {
    fail(fmt::format("{} holds no whole numbers", dataset));
  }
  values.resize(count);
  if (count > 0 &&
      H5Dread(opened.id(), H5T_NATIVE_INT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    fail(fmt::format("{} cannot be read: {}", dataset, hdf5_reason()));
  }
  return values;
}

std::vector<double> Hdf5Reader::rows(const std::string& dataset, std::uint64_t begin,
                                     std::uint64_t count) const {
  Shape part = shape(dataset);
  const QuietHdf5 quiet;
  const Hdf5Handle opened = open(dataset);
  if (part.empty() || begin > part[0] || count > part[0] - begin ||
      !is_stored_as(opened.id(), H5T_FLOAT)) {
    fail(fmt::format("{} does not hold these rows", dataset));
  }
  part[0] = count;
  const std::uint64_t size = volume(dataset, part);
  // The claimed size must be stored, or a few bytes could request gigabytes.
  if (size > H5Dget_storage_size(opened.id())) {
    fail(fmt::format("{} is shorter than it says", dataset));
  }
  std::vector<hsize_t> from(part.size(), 0), extent(part.begin(), part.end());
  from[0] = begin;
  const Hdf5Handle space(H5Dget_space(opened.id()), H5Sclose);
  const Hdf5Handle memory(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr),
                          H5Sclose);
  std::vector<double> values(size);
  if (size == 0) return values;
  if (H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, from.data(), nullptr, extent.data(),
                          nullptr) < 0 ||
      H5Dread(opened.id(), H5T_NATIVE_DOUBLE, memory.id(), space.id(), H5P_DEFAULT, values.data()) <
          0) {
    fail(fmt::format("{} cannot be read: {}", dataset, hdf5_reason()));
  }
  return values;
}

}  // namespace sinew::record
