// The verb "derive": derivatives from a history file.
#include <fmt/format.h>

#include <cmath>

#include "analysis/table.hpp"
#include "app/extraction.hpp"
#include "app/verbs.hpp"

namespace alphadot {

RunStatus derive_verb(const std::string& history_file, Real center_x, const Communicator& comm) {
  comm.on_root([&] {
    const History history = read_history(history_file);
    auto [derivatives, method] = extract_derivatives(history);
    ReferenceSettings reference = history.info.reference;
    if (std::isfinite(center_x)) {
      derivatives = moment_transfer(derivatives, (center_x - reference.moment_center.x) / reference.length);
      reference.moment_center.x = center_x;
    }
    fmt::print("{}", derivative_table(rows_of(derivatives, method), reference));
  });
  return RunStatus::completed;
}

}  // namespace alphadot
