// The verb "check": case and mesh without a run.
#include <fmt/format.h>

#include "app/coarser_meshes.hpp"
#include "app/configuration_view.hpp"
#include "app/load_case.hpp"
#include "app/verbs.hpp"
#include "case_file/case_file.hpp"
#include "derivatives/setup.hpp"

namespace alphadot {

RunStatus check_verb(const CaseArguments& arguments, bool whole_case, const Communicator& comm) {
  const Case settings = load_case(arguments.case_file, arguments.overrides, comm);
  const Setup setup = load_setup(settings, comm);
  setup.domain.validate();
  check_coarser_meshes(setup, comm);
  if (comm.is_root()) {
    for (const auto& warning : setup.warnings) fmt::print("warning: {}\n", warning);
    fmt::print("{}mesh: {} cells, {} points, hash {}; rank 0 of {} holds {} cells and {} ghosts\n{}",
               setup.warnings.empty() ? "case and mesh are fine\n" : "\n", setup.mesh.cells,
               setup.mesh.points, setup.mesh.hash, comm.size(), setup.domain.owned_cells,
               setup.domain.total_cells - setup.domain.owned_cells, configuration_text(setup));
    if (whole_case) fmt::print("\n{}", resolved_case(settings));
  }
  return RunStatus::completed;
}

}  // namespace alphadot
