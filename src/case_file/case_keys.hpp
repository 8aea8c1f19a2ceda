// The keys of the case file, described once: parsing, checks, the resolved case and the documentation follow.
#pragma once

#include <toml++/toml.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "derivatives/case.hpp"

namespace alphadot {

/// One key of the case file, or a family of keys ("boundary.*": any name in that table).
struct CaseKey {
  std::string path;  ///< "freestream.mach"
  struct Limits {
    Real from, to;  ///< both allowed
  };

  std::string type;  ///< for people: "a number from 0.01 to 100"
  std::string doc;
  std::string default_note;      ///< where the default comes from, when it is not a constant
  std::optional<Limits> limits;  ///< of numbers, and of each of several
  bool required = false;
  bool is_text = false;  ///< takes words without quotes on the command line

  /// Stores the value in the case, or says what is wrong with it (file and line are filled in by the caller).
  /// `name` is the last part of the path: the patch, for a family.
  std::function<std::optional<Problem>(std::string_view name, const toml::node& value, Case&)> read;
  /// The lines "name = value\n" that `read` turns into the same settings.
  std::function<std::string(const Case&)> write;

  std::string_view table() const { return {path.data(), path.rfind('.') + 1}; }  ///< "freestream." or ""
  std::string_view name() const { return std::string_view(path).substr(path.rfind('.') + 1); }
  bool is_family() const { return name() == "*"; }
};

/// Of the motion, of a march, between checkpoints.
inline constexpr int most_steps = 100'000'000;

/// Every key, table by table. To add one: a member of its folder's settings and a line in case_keys.cpp.
const std::vector<CaseKey>& case_keys();

/// The key that `path` belongs to, or null.
const CaseKey* find_case_key(std::string_view path);

}  // namespace alphadot
