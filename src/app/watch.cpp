// The verb "watch": follows a run, or every run of a sweep, in the terminal.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <thread>
#include <vector>

#include "app/progress.hpp"
#include "app/run_view.hpp"
#include "app/verbs.hpp"
#include "core/error.hpp"

namespace alphadot {

namespace {

namespace fs = std::filesystem;

constexpr Real long_silence = 30;           // seconds
constexpr std::size_t most_in_detail = 60;  // runs of a sweep

/// "running, silent for 12 min 00 s", "interrupted: stopped by a signal"
std::string state_text(const RunView& view) {
  if (!view.is_running()) return view.state + (view.message.empty() ? "" : ": " + view.message);
  if (view.silence < long_silence) return view.state;
  return fmt::format("{}, silent for {}", view.state, duration_text(view.silence));
}

/// One run on a few lines.
std::string page_of(const RunView& view) {
  std::string out = fmt::format("{}{}{}\n", view.name, view.title.empty() ? "" : ": ", view.title);
  const auto line = [&](const char* label, const std::string& text) {
    if (!text.empty()) out += fmt::format("  {:<12}{}\n", label, text);
  };
  line("state", state_text(view));
  line("phase", view.phase);
  line("left", view.left);
  line("residual", view.residuals);
  line("Cm", view.moments);
  line("forces", view.loads);
  line(view.is_running() ? "so far" : "derivatives", view.derivatives);
  return out;
}

/// Of a great many: those at work, those that did not come to a good end, and how many are in which state.
std::string short_page_of(const std::string& folder, const std::vector<RunView>& views) {
  std::map<std::string, std::size_t> counts;
  std::vector<std::string> lines;
  std::size_t more = 0;
  for (const auto& view : views) {
    ++counts[view.state];
    if (view.state == "converged" || view.state == "completed") continue;
    if (lines.size() == most_in_detail) {
      ++more;
      continue;
    }
    lines.push_back(fmt::format("  {}  {}{}{}\n", view.name, state_text(view), view.phase.empty() ? "" : ", ",
                                view.phase));
  }
  std::string out = fmt::format("{}\n{}", folder, fmt::join(lines, ""));
  if (more) out += fmt::format("  and {} more\n", more);
  out += fmt::format("{} runs:", views.size());
  for (const auto& [state, count] : counts) out += fmt::format(" {} {}", count, state);
  return out + "\n";
}

/// Many runs, two lines each, and how many are in which state.
std::string page_of(const std::string& folder, const std::vector<RunView>& views) {
  if (views.size() > most_in_detail) return short_page_of(folder, views);
  std::string out = folder + "\n";
  std::size_t width = 0, running = 0;
  for (const auto& view : views) width = std::max(width, view.name.size());
  for (const auto& view : views) {
    running += view.is_running();
    const std::string left = view.left.empty() ? "" : ", left " + view.left;
    out += fmt::format("  {:<{}}  {}{}{}{}\n", view.name, width, state_text(view),
                       view.phase.empty() ? "" : ", ", view.phase, left);
    const std::string values = view.loads + (view.derivatives.empty() ? "" : "  ") + view.derivatives;
    if (!values.empty()) out += fmt::format("  {:<{}}  {}\n", "", width, values);
  }
  return out + fmt::format("{} run{}, {} at work\n", views.size(), views.size() == 1 ? "" : "s", running);
}

std::vector<RunView> runs_in(const std::string& folder) {
  std::vector<std::string> folders;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_directory() && is_run_folder(entry.path())) folders.push_back(entry.path());
  std::vector<RunView> out;
  for (const auto& run : folders)
    out.push_back(folders.size() > most_in_detail ? glance_at_run(run) : view_run(run));
  std::ranges::sort(out, {}, &RunView::name);
  return out;
}

struct Page {
  std::string text;
  bool is_final;
};

Page look_at(const std::string& folder) {
  if (is_run_folder(folder)) {
    const RunView view = view_run(folder);
    return {page_of(view), !view.is_running()};
  }
  const auto views = runs_in(folder);
  if (views.empty())
    throw InputError(folder, 0, "there is no run in this folder",
                     "give the folder of a run (--out), or that of a sweep");
  return {page_of(folder, views), false};  // runs may be waiting for their turn
}

}  // namespace

RunStatus watch_verb(const std::string& folder, bool once, Real interval, const Communicator& comm) {
  comm.on_root([&] {
    if (!fs::is_directory(folder)) throw InputError(folder, 0, "there is no such folder", "check the path");
    const bool redraw = !once && isatty(STDOUT_FILENO);
    while (true) {
      const auto [text, is_final] = look_at(folder);
      fmt::print("{}{}", redraw ? "\x1b[H\x1b[J" : "", text);
      std::fflush(stdout);
      if (once || is_final) break;
      std::this_thread::sleep_for(std::chrono::duration<Real>(interval));
    }
  });
  return RunStatus::completed;
}

}  // namespace alphadot
