// From a case to this rank's part of its mesh.
#pragma once

#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "core/error.hpp"
#include "derivatives/case.hpp"
#include "io/result.hpp"
#include "motion/gust.hpp"
#include "motion/motion_table.hpp"
#include "partition/subdomain.hpp"
#include "space/configuration.hpp"

namespace alphadot {

/// What reading and distributing a mesh took, in bytes beyond what the program held before.
struct ReadingMemory {
  Real arrays = 0;        ///< of the subdomains of all ranks
  Real peak = 0;          ///< sum over ranks of the most each held at a time
  Real busiest_rank = 0;  ///< the most that one rank held
};

/// What a computation starts from, the same on every rank but for the subdomain.
struct Setup {
  Case settings;
  MeshResult mesh;
  Subdomain domain;
  ReadingMemory memory;
  std::vector<BoundaryKind> patch_kinds;  ///< of every patch of the mesh, in its order
  Configuration configuration;
  MotionTable motion_table;           ///< for motion.kind = "table"
  GustTable gust_table;               ///< for gust.kind = "table"
  std::string motion_table_hash;      ///< of either, or both
  std::vector<std::string> warnings;  ///< what is improbable about the case with this mesh
};

/// What is wrong with the files that a case names, coarser meshes included. For one rank.
std::vector<Problem> problems_of_files(const Case& settings);

/// Reads, checks and distributes the mesh of a case, matches its patches with [boundary], and reads the table
/// of its motion. A mesh prepared by alphadot partition is read by all ranks at once; any other by the root.
/// Then looks whether the mesh is what the case says. Collective. Throws InputError on every rank.
Setup load_setup(const Case& settings, const Communicator& comm);

}  // namespace alphadot
