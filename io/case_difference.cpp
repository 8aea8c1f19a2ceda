#include "io/case_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "io/case_keys.hpp"

namespace alphadot {
namespace {

/// Tables end with a dot.
constexpr std::string_view free_keys[] = {"title",
                                          "mesh.file",
                                          "output.",
                                          "steady.",
                                          "checkpoint.",
                                          "derivatives.",
                                          "unsteady.cycles",
                                          "unsteady.inner_tolerance",
                                          "unsteady.max_inner"};
constexpr std::string_view free_before_motion[] = {"motion.kind",       "motion.treatment",
                                                   "motion.amplitude",  "motion.reduced_frequency",
                                                   "motion.table_file", "unsteady."};

template <class Keys>
bool names(const Keys& keys, const std::string& path) {
  return std::ranges::any_of(
      keys, [&](auto key) { return key.ends_with('.') ? path.starts_with(key) : path == key; });
}

/// What a key says, on one line. A table may have moved with its folder.
std::string value_of(const CaseKey& key, const Case& c) {
  if (key.path == "motion.table_file") return std::filesystem::path(c.motion.table_file).filename().string();
  std::string text = key.write(c);
  if (!key.is_family()) text.erase(0, text.find(" = ") + 3);
  while (text.ends_with('\n')) text.pop_back();
  std::ranges::replace(text, '\n', ',');
  return text;
}

}  // namespace

std::vector<Problem> contradictions(const Case& before, const Case& now, bool in_motion) {
  std::vector<Problem> out;
  for (const auto& key : case_keys()) {
    if (names(free_keys, key.path) || (!in_motion && names(free_before_motion, key.path))) continue;
    const auto there = value_of(key, before), here = value_of(key, now);
    if (there != here)
      out.push_back({now.file, 0,
                     fmt::format("{} is {}, but the checkpoint was made with {}", key.path, here, there),
                     "restore the key, or run without --restart in another folder"});
  }
  return out;
}

}  // namespace alphadot
