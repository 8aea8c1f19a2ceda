// The case file: TOML text to a checked Case and back.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "derivatives/case.hpp"

namespace alphadot {

/// Reads and checks a case file. Each override, "table.key=value", replaces what the file says; its value is
/// TOML, and a word that is not is taken as text. Paths in the file (mesh.file, motion.table_file) are
/// relative to the folder of the case file, in overrides too; they come back absolute. Throws one InputError
/// with every problem found: file and line for the file, "--set key=value" for an override. Not collective:
/// needs no MPI.
Case read_case(const std::string& path, const std::vector<std::string>& overrides = {});

/// The same from text in memory; `path` serves for messages and to resolve the paths in it.
Case parse_case(std::string_view text, const std::string& path,
                const std::vector<std::string>& overrides = {});

/// A case with all that is wrong with it by itself; keys that are wrong have their defaults.
struct CaseDraft {
  Case settings;
  bool is_readable = false;  ///< as TOML
  std::vector<Problem> problems;
};

/// What parse_case does, for whoever looks for more mistakes elsewhere before complaining.
CaseDraft draft_case(std::string_view text, const std::string& path,
                     const std::vector<std::string>& overrides = {});

/// The text of a case file. Throws InputError. Not collective.
std::string read_case_text(const std::string& path);

/// The whole case as TOML text, defaults included. parse_case turns it back into the same Case (but for
/// `file`), from any folder.
std::string resolved_case(const Case& c);

/// Every key with its type, default and meaning, as text for the terminal.
std::string describe_case_keys();

}  // namespace alphadot
