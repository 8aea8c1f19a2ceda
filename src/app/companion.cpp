#include "app/companion.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "core/error.hpp"
#include "core/run_status.hpp"

namespace alphadot {

namespace fs = std::filesystem;

std::string companion_script(const std::string& name) {
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
  const fs::path installed = program.parent_path() / "../share/alphadot/scripts" / name;
  const fs::path source = fs::path(ALPHADOT_SCRIPTS) / name;
  for (const auto& file : {installed, source})
    if (fs::exists(file, unknown)) return file.lexically_normal().string();
  throw InputError(installed.lexically_normal().string(), 0, "is missing",
                   "install alphadot together with its share folder");
}

int become_companion(const std::string& name, int argc, char** argv) {
  constexpr const char* python = "/usr/bin/python3";
  try {
    std::string script = companion_script(name);
    std::vector<char*> arguments{const_cast<char*>(python), script.data()};
    arguments.insert(arguments.end(), argv + 2, argv + argc);
    arguments.push_back(nullptr);
    execv(python, arguments.data());
    fmt::print(stderr, "alphadot: error: {}: {}; install Debian's python3\n", python, std::strerror(errno));
  } catch (const InputError& error) {
    for (const auto& problem : error.problems()) fmt::print(stderr, "alphadot: error: {}\n", problem.text());
  }
  return exit_code(RunStatus::error);
}

}  // namespace alphadot
