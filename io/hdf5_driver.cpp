#include "io/hdf5_driver.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <limits>

namespace alphadot::hdf5 {
namespace {

/// What the access list carries to `open_file`.
struct DriverInfo {
  int* error;
};

/// An open file of the driver. HDF5 knows it by its first member.
struct DriverFile {
  H5FD_t known{};
  int fd = -1;
  bool is_written = false;    ///< not only read
  haddr_t allocated_end = 0;  ///< of the addresses HDF5 has handed out
  haddr_t written_end = 0;    ///< of what HDF5 believes is on disk
  int* error = nullptr;
};

DriverFile& of(H5FD_t* file) {
  return *reinterpret_cast<DriverFile*>(file);
}
const DriverFile& of(const H5FD_t* file) {
  return *reinterpret_cast<const DriverFile*>(file);
}

void note(const DriverFile& file) {
  if (*file.error == 0) *file.error = errno;
}

H5FD_t* open_file(const char* name, unsigned flags, hid_t access_list, haddr_t) {
  const auto* info = static_cast<const DriverInfo*>(H5Pget_driver_info(access_list));
  const bool is_written = (flags & H5F_ACC_RDWR) != 0;
  const int fd = open(name, O_CLOEXEC | (is_written ? O_RDWR | O_CREAT | O_TRUNC : O_RDONLY), 0666);
  struct stat found {};
  if (fd < 0 || fstat(fd, &found) != 0) {
    *info->error = errno;
    if (fd >= 0) close(fd);
    return nullptr;
  }
  auto* file = new DriverFile;
  file->fd = fd;
  file->is_written = is_written;
  file->written_end = static_cast<haddr_t>(found.st_size);
  file->error = info->error;
  return &file->known;
}

herr_t close_file(H5FD_t* known) {
  auto* file = &of(known);
  if (close(file->fd) != 0 && file->is_written) note(*file);
  delete file;
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t allocated_end(const H5FD_t* file, H5FD_mem_t) {
  return of(file).allocated_end;
}
haddr_t written_end(const H5FD_t* file, H5FD_mem_t) {
  return of(file).written_end;
}
herr_t set_allocated_end(H5FD_t* file, H5FD_mem_t, haddr_t address) {
  of(file).allocated_end = address;
  return 0;
}

herr_t write_bytes(H5FD_t* known, H5FD_mem_t, hid_t, haddr_t address, size_t size, const void* buffer) {
  auto& file = of(known);
  file.written_end = std::max(file.written_end, address + size);
  const char* bytes = static_cast<const char*>(buffer);
  while (size > 0 && *file.error == 0) {
    const auto written = pwrite(file.fd, bytes, size, static_cast<off_t>(address));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      note(file);
      break;
    }
    bytes += written;
    address += static_cast<haddr_t>(written);
    size -= static_cast<size_t>(written);
  }
  return 0;
}

/// Bytes that never reached the disk, or lie behind the end of the file, read as zeros.
herr_t read_bytes(H5FD_t* known, H5FD_mem_t, hid_t, haddr_t address, size_t size, void* buffer) {
  auto& file = of(known);
  char* bytes = static_cast<char*>(buffer);
  while (size > 0) {
    const auto count = pread(file.fd, bytes, size, static_cast<off_t>(address));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && !file.is_written) return -1;
    if (count < 0) note(file);
    if (count <= 0) break;
    bytes += count;
    address += static_cast<haddr_t>(count);
    size -= static_cast<size_t>(count);
  }
  std::memset(bytes, 0, size);
  return 0;
}

herr_t truncate_file(H5FD_t* known, hid_t, hbool_t) {
  auto& file = of(known);
  if (!file.is_written || file.written_end == file.allocated_end) return 0;
  if (*file.error == 0 && ftruncate(file.fd, static_cast<off_t>(file.allocated_end)) != 0) note(file);
  file.written_end = file.allocated_end;
  return 0;
}

H5FD_class_t driver_class() {
  H5FD_class_t driver{};
#ifdef H5FD_CLASS_VERSION
  driver.version = H5FD_CLASS_VERSION;
  driver.value = 600;  // a number for drivers outside the library's registry (512 and above)
#endif
  driver.name = "alphadot";
  driver.maxaddr = static_cast<haddr_t>(std::numeric_limits<off_t>::max());
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.fapl_size = sizeof(DriverInfo);
  driver.open = open_file;
  driver.close = close_file;
  driver.query = query;
  driver.get_eoa = allocated_end;
  driver.set_eoa = set_allocated_end;
  driver.get_eof = written_end;
  driver.read = read_bytes;
  driver.write = write_bytes;
  driver.truncate = truncate_file;
  constexpr H5FD_mem_t memory_classes[] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(memory_classes), std::end(memory_classes), std::begin(driver.fl_map));
  return driver;
}

}  // namespace

void use_deferring_driver(hid_t access_list, int& error) {
  static const H5FD_class_t driver = driver_class();  // HDF5 keeps the name it points to
  const hid_t id = H5FDregister(&driver);
  const DriverInfo info{&error};
  H5Pset_driver(access_list, id, &info);
  H5FDunregister(id);  // the access list, and the file made from it, hold on to the driver
}

}  // namespace alphadot::hdf5
