#include "case_file/suggestion.hpp"

#include <algorithm>
#include <cstdlib>

namespace alphadot {

int edit_distance(std::string_view a, std::string_view b) {
  // Damerau's distance (optimal string alignment) by rows: `before` and `row` are those of the last two
  // letters.
  std::vector<int> before, row(b.size() + 1), next(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    next[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      next[j] = std::min({row[j] + 1, next[j - 1] + 1, row[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        next[j] = std::min(next[j], before[j - 2] + 1);
    }
    before = row;
    row.swap(next);
  }
  return row[b.size()];
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  if (word.size() > 100) return "";
  std::string best;
  int best_distance = static_cast<int>(std::max<std::size_t>(1, (word.size() + 2) / 3)) + 1;
  for (const auto& candidate : candidates) {
    const auto lengths = static_cast<int>(word.size()) - static_cast<int>(candidate.size());
    if (std::abs(lengths) >= best_distance) continue;  // the distance is at least that
    const int distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace alphadot
