#include "app/centers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "core/error.hpp"
#include "io/files.hpp"

namespace alphadot {

namespace {

constexpr const char* blanks = " \t\r";

/// Farther away no digit of a place is left.
constexpr Real farthest = 1e12;

/// Numbers between commas, with blanks around them; nothing when one is none or too large.
std::optional<std::vector<Real>> numbers_in(const std::string& text) {
  std::vector<Real> out;
  for (const char* at = text.c_str();; ++at) {
    char* end = nullptr;
    const Real value = std::strtod(at, &end);
    if (end == at || !(std::abs(value) <= farthest)) return std::nullopt;
    out.push_back(value);
    at = end + std::strspn(end, blanks);
    if (*at == '\0') return out;
    if (*at != ',') return std::nullopt;
  }
}

Center center_of(const std::string& text, const std::string& file, int line) {
  const auto numbers = numbers_in(text);
  if (numbers && numbers->size() == 1) return {(*numbers)[0]};
  if (numbers && numbers->size() == 3) return {(*numbers)[0], std::pair{(*numbers)[1], (*numbers)[2]}};
  throw InputError(file, line, fmt::format("\"{}\" is no moment centre", text),
                   "give x or x,y,z in the mesh's unit, numbers of at most 1e12");
}

}  // namespace

Center parse_center(const std::string& text) {
  return center_of(text, "--center", 0);
}

std::vector<Center> read_centers(const std::string& path) {
  constexpr std::uintmax_t most_bytes = 1 << 24;
  std::istringstream lines(read_file(path, "file of centres", most_bytes));
  std::vector<Center> out;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line.erase(std::min(line.find('#'), line.size()));
    const auto begin = line.find_first_not_of(blanks);
    if (begin == std::string::npos) continue;
    out.push_back(center_of(line.substr(begin, line.find_last_not_of(blanks) + 1 - begin), path, number));
  }
  if (out.empty()) throw InputError(path, 0, "holds no centre", "write one a line: x or x,y,z");
  return out;
}

}  // namespace alphadot
