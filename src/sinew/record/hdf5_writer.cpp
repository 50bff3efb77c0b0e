#include "sinew/record/hdf5_writer.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>
#include <numeric>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "sinew/core/file.hpp"
#include "sinew/record/hdf5_handle.hpp"

namespace sinew::record {

namespace {

constexpr std::uint64_t kChunkBytes = 4096;  // of series whose frames are small
constexpr std::uint64_t kHeadroom = 4096;    // bytes for the index of a series

using Extent = std::vector<hsize_t>;

std::uint64_t volume(const std::vector<std::uint64_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>());
}

// Metadata stay in memory until they are flushed, so that a crash leaves the file in the state of
// the last flush.
Hdf5Handle access_properties() {
  Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5AC_cache_config_t cache;
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  if (H5Pget_mdc_config(access.id(), &cache) >= 0) {
    cache.evictions_enabled = false;
    cache.incr_mode = H5C_incr__off;
    cache.flash_incr_mode = H5C_flash_incr__off;
    cache.decr_mode = H5C_decr__off;
    H5Pset_mdc_config(access.id(), &cache);
  }
  return access;
}

Hdf5Handle text_type(std::string_view text) {
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), std::max<std::size_t>(text.size(), 1));
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

// The reason, as in errno, for which a file cannot be created; 0 if it can be.
int why_not_created(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) return errno;
  ::close(file);
  return 0;
}

}  // namespace

struct Hdf5Writer::File {
  struct Series {
    Hdf5Handle dataset;
    Extent extent;                   // (frames, shape...) that HDF5 has
    std::uint64_t frames = 0;        // with those that wait
    std::uint64_t size = 0;          // numbers in a frame
    std::uint64_t chunk_frames = 1;  // frames in a chunk
    std::vector<double> waiting;     // frames not yet passed to HDF5, less than a chunk
    std::uint64_t chunk_bytes() const { return chunk_frames * size * sizeof(double); }
  };

  std::string path;
  Hdf5Handle file;
  Hdf5Handle links;  // makes the groups above a path
  std::vector<Series> series;
  haddr_t reserved = 0;       // bytes reserved from the start of the file
  haddr_t filled = 0;         // of which the last flush needs all
  std::uint64_t pending = 0;  // bytes of chunks begun since the last flush
  bool abandoned = false;
  std::chrono::steady_clock::time_point flushed = std::chrono::steady_clock::now();

  [[noreturn]] void fail(const std::string& what, const std::string& reason) {
    abandon();
    throw Error(ErrorKind::recording_failed, {.file = path, .item = what},
                fmt::format("the record cannot be written: {}", reason),
                "check that the disk is not full; what was recorded before is readable");
  }
  void expect(bool good, const std::string& what) {
    if (!good) fail(what, hdf5_reason());
  }
  int descriptor() const {
    void* handle = nullptr;
    const bool found = H5Fget_vfd_handle(file.id(), H5P_DEFAULT, &handle) >= 0 && handle != nullptr;
    return found ? *static_cast<int*>(handle) : -1;
  }
  // Redirects all further writes of HDF5 to memory. The file keeps the state of the last flush, and
  // closing succeeds: HDF5 crashes at the exit of a program that could not close a file. A file in
  // memory, unlike /dev/null, can be truncated, which HDF5 does when it closes.
  void abandon() {
    if (abandoned) return;
    abandoned = true;
    const int kept = descriptor();
    int elsewhere = ::memfd_create("abandoned", MFD_CLOEXEC);
    if (elsewhere < 0) elsewhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    if (kept >= 0 && elsewhere >= 0) ::dup3(elsewhere, kept, O_CLOEXEC);
    if (elsewhere >= 0) ::close(elsewhere);
  }
  haddr_t end() const {
    haddr_t bytes = 0;
    return H5Fget_eoa(file.id(), &bytes) >= 0 ? bytes : 0;
  }
  // Reserves disk space before HDF5 needs it. HDF5 cannot close a file after a write of metadata
  // that failed, and then crashes at the exit of the program.
  /// @param extra bytes beyond the space that HDF5 has allocated. @return error as in errno; 0 if
  /// there is none.
  int reserve(haddr_t extra) {
    const haddr_t wanted = end() + extra;
    if (wanted <= reserved) return 0;
    const int problem = ::posix_fallocate(descriptor(), static_cast<off_t>(reserved),
                                          static_cast<off_t>(wanted - reserved));
    if (problem == 0) reserved = wanted;
    return problem;
  }
  // Room for the chunks in memory, and for growth of the index of every series.
  haddr_t growth() const { return pending + kHeadroom * (series.size() + 16); }
  // Releases unused space, since HDF5 truncates the file when it flushes. What HDF5 has allocated
  // and not written stays reserved.
  void release() {
    pending = 0;
    if (::ftruncate(descriptor(), static_cast<off_t>(end())) != 0) filled = 0;
    reserved = filled;
    if (reserve(0) == 0) filled = reserved;
  }
  // Reserves space, or fails after writing all earlier frames, for which space was reserved before.
  void require_room(haddr_t more = 0) {
    const int problem = reserve(growth() + more);
    if (problem == 0) return;
    const bool has_room = reserve(0) == 0;
    for (Series& one : series) {
      if (has_room) write_waiting(one);
    }
    if (has_room && reserve(0) == 0) H5Fflush(file.id(), H5F_SCOPE_LOCAL);
    fail("series", std::strerror(problem));
  }
  void write_frames(Series& target, std::uint64_t frames, std::span<const double> values) {
    Extent begin(target.extent.size(), 0), count = target.extent;
    begin[0] = target.extent[0];
    count[0] = frames;
    target.extent[0] += frames;
    expect(H5Dset_extent(target.dataset.id(), target.extent.data()) >= 0, "series");
    const Hdf5Handle space(H5Dget_space(target.dataset.id()), H5Sclose);
    const Hdf5Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr),
                            H5Sclose);
    const bool written = H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, begin.data(), nullptr,
                                             count.data(), nullptr) >= 0 &&
                         H5Dwrite(target.dataset.id(), H5T_NATIVE_DOUBLE, memory.id(), space.id(),
                                  H5P_DEFAULT, values.data()) >= 0;
    expect(written, "series");
  }
  void write_waiting(Series& target) {
    if (target.waiting.empty()) return;
    write_frames(target, target.frames - target.extent[0], target.waiting);
    target.waiting.clear();
  }
  void write(const std::string& name, const Extent& shape, hid_t stored, hid_t type,
             const void* values) {
    const QuietHdf5 quiet;
    haddr_t bytes = H5Tget_size(stored);
    for (const hsize_t size : shape) bytes *= size;
    require_room(bytes);
    const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                           H5Sclose);
    const Hdf5Handle set(H5Dcreate2(file.id(), name.c_str(), stored, space.id(), links.id(),
                                    H5P_DEFAULT, H5P_DEFAULT),
                         H5Dclose);
    expect(set.valid() && H5Dwrite(set.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0,
           name);
  }
  void write_attribute(const std::string& object, const std::string& name, hid_t type,
                       const void* value) {
    const QuietHdf5 quiet;
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle set(H5Acreate_by_name(file.id(), object.c_str(), name.c_str(), type,
                                           space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
    expect(set.valid() && H5Awrite(set.id(), type, value) >= 0, object + "@" + name);
  }
};

Hdf5Writer::Hdf5Writer(const std::filesystem::path& path) : file_(std::make_unique<File>()) {
  const QuietHdf5 quiet;
  file_->path = path.string();
  const Hdf5Handle access = access_properties();
  file_->file =
      Hdf5Handle(H5Fcreate(file_->path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose);
  if (!file_->file.valid()) {
    if (const int reason = why_not_created(path); reason != 0) throw_unwritable(path, reason);
    throw Error(ErrorKind::file_unwritable, {.file = file_->path},
                fmt::format("the record cannot be created: {}", hdf5_reason()),
                "check that its folder may be written to and that no program has the file open");
  }
  file_->links = Hdf5Handle(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(file_->links.id(), 1);
}

Hdf5Writer::~Hdf5Writer() {
  if (!file_) return;
  const QuietHdf5 quiet;
  try {
    flush();
  } catch (const Error&) {
    // The file keeps the state of the last flush. Errors are reported by flush().
  }
  file_.reset();
}
Hdf5Writer::Hdf5Writer(Hdf5Writer&&) noexcept = default;
Hdf5Writer& Hdf5Writer::operator=(Hdf5Writer&&) noexcept = default;

void Hdf5Writer::attribute(const std::string& object, const std::string& name,
                           std::string_view value) {
  // Variable-length strings are str in h5py.
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  const std::string text(value);
  const char* pointer = text.c_str();
  file_->write_attribute(object, name, type.id(), &pointer);
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, double value) {
  file_->write_attribute(object, name, H5T_NATIVE_DOUBLE, &value);
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, std::int64_t value) {
  file_->write_attribute(object, name, H5T_NATIVE_INT64, &value);
}

void Hdf5Writer::group(const std::string& path) {
  const QuietHdf5 quiet;
  const Hdf5Handle made(
      H5Gcreate2(file_->file.id(), path.c_str(), file_->links.id(), H5P_DEFAULT, H5P_DEFAULT),
      H5Gclose);
  file_->expect(made.valid(), path);
}

void Hdf5Writer::dataset(const std::string& path, const std::vector<std::uint64_t>& shape,
                         std::span<const double> values) {
  file_->expect(values.size() == volume(shape), path);
  file_->write(path, Extent(shape.begin(), shape.end()), H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
               values.data());
}

void Hdf5Writer::dataset(const std::string& path, const std::vector<std::uint64_t>& shape,
                         std::span<const std::int32_t> values) {
  file_->expect(values.size() == volume(shape), path);
  file_->write(path, Extent(shape.begin(), shape.end()), H5T_STD_I32LE, H5T_NATIVE_INT32,
               values.data());
}

void Hdf5Writer::text(const std::string& path, std::string_view text) {
  const QuietHdf5 quiet;
  file_->require_room(text.size());
  const Hdf5Handle type = text_type(text);
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle set(H5Dcreate2(file_->file.id(), path.c_str(), type.id(), space.id(),
                                  file_->links.id(), H5P_DEFAULT, H5P_DEFAULT),
                       H5Dclose);
  file_->expect(set.valid() && H5Dwrite(set.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                        text.empty() ? "" : text.data()) >= 0,
                path);
}

int Hdf5Writer::series(const std::string& path, const std::vector<std::uint64_t>& shape) {
  const QuietHdf5 quiet;
  file_->require_room();
  File::Series made;
  made.size = volume(shape);
  made.extent.assign(shape.begin(), shape.end());
  made.extent.insert(made.extent.begin(), 0);
  Extent most = made.extent, chunk = made.extent;
  most[0] = H5S_UNLIMITED;
  chunk[0] =
      std::max<hsize_t>(1, kChunkBytes / std::max<std::uint64_t>(1, made.size * sizeof(double)));
  made.chunk_frames = chunk[0];
  for (std::size_t i = 1; i < chunk.size(); ++i) chunk[i] = std::max<hsize_t>(chunk[i], 1);
  const int rank = static_cast<int>(made.extent.size());
  const Hdf5Handle space(H5Screate_simple(rank, made.extent.data(), most.data()), H5Sclose);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(creation.id(), rank, chunk.data());
  made.dataset = Hdf5Handle(H5Dcreate2(file_->file.id(), path.c_str(), H5T_IEEE_F64LE, space.id(),
                                       file_->links.id(), creation.id(), H5P_DEFAULT),
                            H5Dclose);
  file_->expect(made.dataset.valid(), path);
  // For small frames, most of the cost is the call of HDF5, so a whole chunk is written at once.
  if (made.chunk_frames > 1 && made.size > 0) made.waiting.reserve(made.chunk_frames * made.size);
  file_->series.push_back(std::move(made));
  return static_cast<int>(file_->series.size()) - 1;
}

void Hdf5Writer::append(int series, std::span<const double> values) {
  const QuietHdf5 quiet;
  File::Series& target = file_->series.at(static_cast<std::size_t>(series));
  if (file_->abandoned) file_->fail("series", "an earlier frame could not be written");
  file_->expect(values.size() == target.size, "series");
  if (target.frames % target.chunk_frames == 0) {
    file_->pending += target.chunk_bytes();
    file_->require_room();
  }
  ++target.frames;
  if (target.waiting.capacity() == 0) return file_->write_frames(target, 1, values);
  target.waiting.insert(target.waiting.end(), values.begin(), values.end());
  if (target.frames - target.extent[0] == target.chunk_frames) file_->write_waiting(target);
}

void Hdf5Writer::flush() {
  if (file_->abandoned) return;
  const QuietHdf5 quiet;
  file_->require_room();
  for (File::Series& one : file_->series) file_->write_waiting(one);
  file_->expect(H5Fflush(file_->file.id(), H5F_SCOPE_LOCAL) >= 0, "flush");
  file_->release();
  file_->flushed = std::chrono::steady_clock::now();
}

void Hdf5Writer::rename(const std::filesystem::path& path) {
  replace_file(file_->path, path);
  file_->path = path.string();
}

void Hdf5Writer::flush_after(std::chrono::milliseconds interval) {
  if (std::chrono::steady_clock::now() - file_->flushed >= interval) flush();
}

}  // namespace sinew::record
