// The case written out: the resolved case and the documentation of its keys.
#include <fmt/format.h>

#include <algorithm>

#include "case_file/case_file.hpp"
#include "case_file/case_keys.hpp"

namespace alphadot {
namespace {

/// "\n[table]\n" when `key` begins a new table.
std::string heading(const CaseKey& key, std::string& current) {
  if (key.table() == current) return "";
  current = key.table();
  return "\n[" + current.substr(0, current.size() - 1) + "]\n";
}

/// "required", "optional" or "default ...": what a case without the key gets.
std::string default_of(const CaseKey& key) {
  if (key.required) return "required";
  if (!key.default_note.empty()) return "default " + key.default_note;
  const std::string line = key.write(Case{});
  if (line.empty()) return "optional";
  const std::string value = line.substr(line.find(" = ") + 3, line.size() - line.find(" = ") - 4);
  return value == "\"\"" ? "optional" : "default " + value;
}

}  // namespace

std::string resolved_case(const Case& c) {
  std::string text, table;
  for (const auto& key : case_keys())
    if (const auto lines = key.write(c); !lines.empty()) text += heading(key, table) + lines;
  return text;
}

std::string describe_case_keys() {
  std::string text, table;
  for (const auto& key : case_keys()) {
    text += heading(key, table);
    text += fmt::format("  {:<18} {}\n  {:<18} {}, {}\n", key.is_family() ? "<name>" : key.name(), key.doc,
                        "", key.type, default_of(key));
  }
  return text;
}

}  // namespace alphadot
