// The verb "derive": derivatives from a history file.
#include <fmt/format.h>

#include <optional>

#include "analysis/table.hpp"
#include "app/extraction.hpp"
#include "app/verbs.hpp"

namespace alphadot {

RunStatus derive_verb(const std::string& history_file, std::optional<Real> center_x,
                      const Communicator& comm) {
  comm.on_root([&] {
    const History history = read_history(history_file);
    auto [estimated, method] = extract_derivatives(history);
    ReferenceSettings reference = history.info.reference;
    if (center_x) {
      estimated.derivatives =
          moment_transfer(estimated.derivatives, (*center_x - reference.moment_center.x) / reference.length);
      estimated.parts.clear();
      reference.moment_center.x = *center_x;
    }
    const auto rows = rows_of(estimated.derivatives, method, Axes::body, estimated.parts);
    fmt::print("{}", derivative_table(rows, {reference, history.info.status, uncertainty_scope(rows),
                                             history.info.origin().text()}));
  });
  return RunStatus::completed;
}

}  // namespace alphadot
