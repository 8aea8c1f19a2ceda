#include "core/error.hpp"

#include <fmt/format.h>

#include <utility>

namespace alphadot {

std::string Problem::text() const {
  std::string out = file;
  if (!file.empty() && line > 0) out += fmt::format(":{}", line);
  if (!file.empty()) out += ": ";
  out += what;
  if (!remedy.empty()) out += fmt::format("; {}", remedy);
  return out;
}

Problem out_of_memory(int rank) {
  return {"", 0, fmt::format("the memory does not suffice on rank {}", rank),
          "use more ranks on more machines, or a coarser mesh"};
}

namespace {
std::string joined(const std::vector<Problem>& problems) {
  std::string out;
  for (const auto& problem : problems) out += fmt::format("{}{}", out.empty() ? "" : "\n", problem.text());
  return out;
}
}  // namespace

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

InputError::InputError(std::string file, int line, std::string what, std::string remedy)
    : InputError({Problem{std::move(file), line, std::move(what), std::move(remedy)}}) {}

}  // namespace alphadot
