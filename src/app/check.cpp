// The verb "check": case and mesh without a run.
#include <fmt/format.h>

#include "app/setup.hpp"
#include "app/verbs.hpp"
#include "io/case_file.hpp"

namespace alphadot {

RunStatus check_verb(const CaseArguments& arguments, const Communicator& comm) {
  const Case settings = load_case(arguments.case_file, arguments.overrides, comm);
  const Setup setup = load_setup(settings, comm);
  setup.domain.validate();
  if (comm.is_root())
    fmt::print(
        "{}\n# mesh: {} cells, {} points, hash {}; rank 0 of {} holds {} cells and {} ghosts\ncase and mesh "
        "are fine\n",
        resolved_case(settings), setup.mesh.cells, setup.mesh.points, setup.mesh.hash, comm.size(),
        setup.domain.owned_cells, setup.domain.total_cells - setup.domain.owned_cells);
  return RunStatus::completed;
}

}  // namespace alphadot
