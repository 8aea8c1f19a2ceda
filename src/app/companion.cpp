#include "app/companion.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
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

namespace {

constexpr const char* python = "/usr/bin/python3";

}  // namespace

int become_companion(const std::string& name, int argc, char** argv) {
  try {
    std::string script = companion_script(name);
    std::error_code unknown;
    const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
    if (!unknown) setenv("ALPHADOT", program.c_str(), 1);  // for scripts that run it
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

std::string output_of_companion(const std::string& name, const std::vector<std::string>& arguments) {
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    throw InputError(name, 0, what, remedy);
  };
  std::vector<std::string> words{python, companion_script(name)};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv(words.size() + 1, nullptr);
  std::ranges::transform(words, argv.begin(), [](std::string& word) { return word.data(); });
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) refuse(std::strerror(errno), "close other programs");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  pid_t child = 0;
  const int failure = posix_spawn(&child, python, &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::string text;
  std::array<char, 4096> part{};
  for (ssize_t got = 0; failure == 0; text.append(part.data(), static_cast<std::size_t>(got))) {
    do got = read(ends[0], part.data(), part.size());
    while (got < 0 && errno == EINTR);
    if (got <= 0) break;
  }
  close(ends[0]);
  if (failure != 0) refuse(fmt::format("{}: {}", python, std::strerror(failure)), "install Debian's python3");
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    refuse("has ended with an error", "see the lines above");
  while (text.ends_with('\n')) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace alphadot
