#include "case_file/case_difference.hpp"

#include <algorithm>
#include <string_view>

#include "case_file/case_keys.hpp"

namespace alphadot {
namespace {

/// Tables end with a dot.
constexpr std::string_view always_free[] = {
    "title",           "mesh.file",         "mesh.from",      "mesh.level",  "output.",
    "checkpoint.",     "estimates.",        "derivatives.",   "components.", "control_sets.",
    "unsteady.cycles", "motion.table_file", "gust.table_file"};
constexpr std::string_view free_in_motion[] = {"steady.", "unsteady.inner_tolerance", "unsteady.max_inner"};
constexpr std::string_view free_in_flow[] = {
    "motion.kind", "motion.treatment", "motion.amplitude", "motion.reduced_frequency", "unsteady.", "body.",
    "gust."};

template <class Keys>
bool names(const Keys& keys, const std::string& path) {
  return std::ranges::any_of(
      keys, [&](auto key) { return key.ends_with('.') ? path.starts_with(key) : path == key; });
}

/// What a key says, on one line.
std::string value_of(const CaseKey& key, const Case& c) {
  std::string text = key.write(c);
  if (!key.is_family()) text.erase(0, text.find(" = ") + 3);
  while (text.ends_with('\n')) text.pop_back();
  std::ranges::replace(text, '\n', ',');
  return text;
}

}  // namespace

std::vector<KeyDifference> differences(const Case& before, const Case& now, Shared shared) {
  std::vector<KeyDifference> out;
  for (const auto& key : case_keys()) {
    if (names(always_free, key.path)) continue;
    if (key.path == "controls" && before.deflections.empty() && now.deflections.empty()) continue;
    if (shared != Shared::steps && names(free_in_motion, key.path)) continue;
    if (shared == Shared::flow && names(free_in_flow, key.path)) continue;
    const auto there = value_of(key, before), here = value_of(key, now);
    if (there != here) out.push_back({key.path, there, here});
  }
  return out;
}

}  // namespace alphadot
