// What the program can be asked to do; one function a verb.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "core/run_status.hpp"
#include "partition/decompose.hpp"

namespace alphadot {

/// Where a run keeps its files and what it begins from.
struct RunOptions {
  std::string folder;          ///< of the run; empty: as the case says
  std::string stop_folder;     ///< where a file "stop" ends it; empty: in its folder
  bool may_overwrite = false;  ///< results of another flow or verb in the folder
  /// Go on from this checkpoint; empty: from the newest of the run's folder.
  std::optional<std::string> restart;
};

struct CaseArguments : RunOptions {
  std::string case_file;
  std::vector<std::string> overrides;  ///< "key=value"
};

struct PartitionArguments {
  std::string mesh;
  std::string output;  ///< empty: the mesh's name with the extension .h5
  int pieces = 1;
  std::vector<std::string> thin;  ///< patches inside the mesh that become walls with two sides
  int refinements = 0;            ///< times that every tetrahedron is cut into eight first
  Partitioner partitioner = Partitioner::metis;
};

struct DeriveArguments {
  std::vector<std::string> files;    ///< history.h5 or result.json
  std::vector<std::string> centers;  ///< "x" or "x,y,z" in the unit of the reference length; none here and
                                     ///< below: that of each file
  std::string centers_file;          ///< with a centre a line; empty: none
  bool as_json = false;
};

/// Steady state, then the motion that the case asks for, derivatives, and everything written into the run's
/// folder.
RunStatus run_verb(const CaseArguments& arguments, const Communicator& comm);

/// Steady state, then the matrix of stability derivatives from linear solves: all six coefficients with
/// respect to alpha, q and alphadot, and on a full model beta, p, r and betadot.
RunStatus derivatives_verb(const CaseArguments& arguments, const Communicator& comm);

/// Steady state, then the adjoints of loads: `of` names them ("Cm", "Cm_alphadot", "CN@fin_1+fin_2"; none:
/// all coefficients). Writes their derivatives, and the fields that show which cells a load listens to. With
/// derivatives to adapt a mesh to ("Cm_alphadot") also where on the mesh their errors are made.
RunStatus adjoint_verb(const CaseArguments& arguments, const std::vector<std::string>& of,
                       const std::vector<std::string>& adapt_to, const Communicator& comm);

/// Steady state, then its linear responses to flight variables that oscillate at the reduced frequencies `k`
/// = omega length / 2V: alpha and q, on a full model beta, p and r too.
RunStatus frequency_verb(const CaseArguments& arguments, std::vector<Real> k, bool with_gusts,
                         const Communicator& comm);

/// Reads and checks case and mesh; prints what is improbable first, then what a run would work on, and on
/// demand the whole case with every default.
RunStatus check_verb(const CaseArguments& arguments, bool whole_case, const Communicator& comm);

/// Prepares a mesh for reading by many ranks at once.
RunStatus partition_verb(const PartitionArguments& arguments, const Communicator& comm);

/// Prints derivatives of histories and results about any centres: a table each, and the travel of the centre
/// of gravity where there are several; or all as JSON, with the loads of the steady flow or of every step.
/// All files and centres are read before anything is printed.
RunStatus derive_verb(const DeriveArguments& arguments, const Communicator& comm);

/// Prints what a file is and holds: mesh, history, checkpoint or result.
RunStatus info_verb(const std::string& file, const Communicator& comm);

/// Shows the residual, the forces and the derivatives so far of a run's folder, or of every run in a sweep's
/// folder: once, or every `interval` seconds until the run ends (a sweep: until interrupted).
RunStatus watch_verb(const std::string& folder, bool once, Real interval, const Communicator& comm);

}  // namespace alphadot
