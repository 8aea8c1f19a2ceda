// A checkpoint: everything a run needs to go on as if it had not stopped, in one HDF5 file for any number of
// ranks.
//
// The file is a VTKHDF file as well, which ParaView opens: the states of the cells, in the order of the mesh
// file, are its cell data (five components each), and the mesh is in it. Beside the group VTKHDF stand "head"
// (numbers of the march, resolved case, hash of the mesh) and "history". A seal (seal.hpp) ends the file.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "core/five.hpp"
#include "io/history.hpp"
#include "partition/slabs.hpp"
#include "partition/subdomain.hpp"

namespace alphadot {

/// What a checkpoint holds besides the states of the cells.
struct CheckpointHead {
  std::string phase;  ///< what the run was doing: "steady", "motion" or "derivatives"
  /// Counters and norms of the march by name. Reals keep every bit; integers up to 2^53 are exact.
  std::map<std::string, std::vector<Real>> numbers;
  std::string message;  ///< of the run so far
  History history;      ///< so far, with the resolved case, the mesh's hash and the program's version
};

/// States of the owned cells under a name. For writing [owned_cells] or more; for reading they are filled.
struct CheckpointField {
  std::string name;
  std::span<Five<Real>> values;
};

/// Writes and reads the checkpoints of one distributed mesh.
class CheckpointFile {
 public:
  /// Collective. The domain must outlive the object.
  CheckpointFile(const Subdomain& domain, const Communicator& comm);

  /// Writes under a temporary name, reads back what was written and compares it with sums over all cells of a
  /// hash of the values in memory, seals the file, and only then gives it its name. No rank holds more than
  /// its share. Collective; throws InputError on every rank, leaving a file of that name as it was.
  void write(const std::string& path, const CheckpointHead& head,
             const std::vector<CheckpointField>& fields) const;

  /// Fills `fields` from a checkpoint, written on any number of ranks. Collective; throws InputError on every
  /// rank when the states do not belong to this mesh or are not those that were written.
  void read_fields(const std::string& path, const std::vector<CheckpointField>& fields) const;

 private:
  const Subdomain& domain_;
  Communicator comm_;
  Slabs cells_, points_;
};

/// Reads the head of a checkpoint whose seal is whole. For one rank; throws InputError when the file is
/// damaged or of another kind or version.
CheckpointHead read_checkpoint_head(const std::string& path);

/// The states in a checkpoint whose seal is whole: their names, and for how many cells.
struct CheckpointStates {
  std::vector<std::string> names;
  GlobalIndex cells = 0;
};

/// For one rank; throws InputError.
CheckpointStates read_checkpoint_states(const std::string& path);

}  // namespace alphadot
