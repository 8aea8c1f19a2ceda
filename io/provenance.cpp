#include "io/provenance.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "build_info.hpp"

namespace alphadot {
namespace {

/// "Open MPI v4.1.4" out of the library's long description.
std::string mpi_version() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  MPI_Get_library_version(text, &length);
  const std::string all(text, static_cast<std::size_t>(length));
  return all.substr(0, all.find_first_of(",\n"));
}

std::string hdf5_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

std::string cpu_model() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(':') + 2));
  return "unknown";
}

std::string host_name() {
  char name[256] = "";
  gethostname(name, sizeof name - 1);
  return name;
}

}  // namespace

std::string Origin::text() const {
  std::string name = std::filesystem::path(mesh_file).filename().string();
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  return fmt::format("Mach {}, alpha {} deg, beta {} deg, gamma {}; mesh {}, hash {}; alphadot {}",
                     freestream.mach, freestream.alpha, freestream.beta, freestream.gamma, name, mesh_hash,
                     version);
}

Provenance provenance(int ranks) {
  return {.version = build_info::version,
          .commit = build_info::commit,
          .compiler = build_info::compiler,
          .flags = build_info::flags,
          .build_type = build_info::build_type,
          .mpi_version = mpi_version(),
          .hdf5_version = hdf5_version(),
          .cpu = cpu_model(),
          .host = host_name(),
          .date = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))),
          .ranks = ranks};
}

std::string version_line() {
  return fmt::format("alphadot {} ({}, {}, {})", build_info::version, build_info::commit,
                     build_info::compiler, build_info::build_type);
}

}  // namespace alphadot
