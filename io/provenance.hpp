// What made a result: the program, its build, the machine and the moment.
#pragma once

#include <string>

#include "core/flight.hpp"

namespace alphadot {

/// Which flow the numbers of a file are of, and what computed them.
struct Origin {
  FreestreamSettings freestream;
  std::string mesh_file, mesh_hash;
  std::string version;  ///< of alphadot

  /// On one line: "Mach 2, alpha 1.5 deg, beta 0 deg, gamma 1.4; mesh box.msh, hash 0123456789abcdef;
  /// alphadot 0.1.0".
  std::string text() const;
};

struct Provenance {
  std::string version;       ///< of alphadot, "0.1.0"
  std::string commit;        ///< of the sources at build time, "-dirty" when they were changed, or "unknown"
  std::string compiler;      ///< "GNU 12.2.0"
  std::string flags;         ///< of the compiler
  std::string build_type;    ///< "Release"
  std::string mpi_version;   ///< of the library at run time
  std::string hdf5_version;  ///< of the library at run time
  std::string cpu;           ///< model of this host's processor
  std::string host;          ///< name of this host
  std::string date;          ///< now, UTC, "2024-05-01T12:00:00Z"
  int ranks = 1;
};

/// Gathers the above on this rank. Not collective.
Provenance provenance(int ranks);

/// "alphadot 0.1.0 (commit, compiler, build type)": for --version.
std::string version_line();

}  // namespace alphadot
