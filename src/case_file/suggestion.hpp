// "Did you mean": the known word nearest to one that is not known.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace alphadot {

/// Number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`.
int edit_distance(std::string_view a, std::string_view b);

/// The candidate nearest to `word`, or "" when none is near enough to be a slip of the hand (about a third of
/// its letters). Words above 100 characters get no suggestion.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace alphadot
