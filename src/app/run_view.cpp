#include "app/run_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "app/progress.hpp"
#include "io/files.hpp"
#include "io/live_table.hpp"

namespace alphadot {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t bars = 60;  // of a row

/// Null where there is no such file or no JSON in it.
Json read_json(const std::string& path) {
  auto json = Json::parse(content_of(path), nullptr, false);
  return json.is_object() ? json : Json();
}

Real seconds_since_written(const std::string& path) {
  std::error_code error;
  const auto written = fs::last_write_time(path, error);
  if (error) return 0;
  return std::max(std::chrono::duration<Real>(fs::file_time_type::clock::now() - written).count(), Real{0});
}

std::string text_of(const Json& json, const std::string& key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

Real number_of(const Json& json, const std::string& key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<Real>() : NAN;
}

std::string loads_text(const Json& values) {
  std::string out;
  for (const auto* name : {"CA", "CN", "Cm"})
    if (const Real value = number_of(values, name); std::isfinite(value))
      out += fmt::format("{}{} {:+.6f}", out.empty() ? "" : "  ", name, value);
  return out;
}

/// Those of the moments first, as they are what is waited for. Entries are numbers, or objects with value and
/// uncertainty.
std::string derivatives_text(const Json& values) {
  std::string out;
  for (const auto* prefix : {"Cm_", "CN_", "Cn_", "Cl_"})
    for (const auto& [name, entry] : values.items()) {
      if (!name.starts_with(prefix)) continue;
      const Real value = entry.is_number() ? entry.get<Real>() : number_of(entry, "value");
      const Real error = entry.is_object() ? number_of(entry, "uncertainty") : NAN;
      out += fmt::format("{}{} {:+.4g}", out.empty() ? "" : "  ", name, value);
      if (std::isfinite(error)) out += fmt::format(" +- {:.1g}", error);
    }
  return out;
}

/// Values as bars between their least and largest.
std::string bars_of(std::span<const Real> values) {
  constexpr std::array blocks{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  if (values.empty()) return "";
  const auto [low, high] = std::ranges::minmax(values);
  std::string out;
  const std::size_t count = std::min(bars, values.size());
  for (std::size_t bar = 0; bar < count; ++bar) {
    const Real value = values[(bar + 1) * values.size() / count - 1];
    const Real height = high > low ? (value - low) / (high - low) : 0;
    out += blocks[static_cast<std::size_t>(std::lround(7 * height))];
  }
  return out;
}

std::string residual_row(const std::string& folder) {
  const Table table = read_table(folder + "/steady.csv");
  const auto* orders = table.find("orders");
  if (!orders || orders->empty()) return "";
  std::vector<Real> residual;
  for (const Real value : *orders) residual.push_back(-value);
  return fmt::format("{}  1e{:+.1f} after {} iterations", bars_of(residual), residual.back(),
                     static_cast<long>(table.find("iteration")->back()));
}

std::string moment_row(const std::string& folder) {
  const Table table = read_table(folder + "/history.csv");
  const auto* moment = table.find("total/Cm");
  if (!moment || moment->empty()) return "";
  const auto [low, high] = std::ranges::minmax(*moment);
  return fmt::format("{}  {:+.4f} to {:+.4f} in {} steps", bars_of(*moment), low, high, moment->size());
}

/// A string at the beginning of a result, which need not be parsed for it; empty where it is not found.
std::string string_at(std::string_view head, std::string_view key) {
  const auto start = head.find(fmt::format("\"{}\": \"", key));
  if (start == std::string_view::npos) return "";
  const auto quote = start + key.size() + 4;
  auto end = quote + 1;
  while (end < head.size() && head[end] != '"') end += head[end] == '\\' ? 2 : 1;
  if (end >= head.size()) return "";
  const auto text = Json::parse(head.substr(quote, end + 1 - quote), nullptr, false);
  return text.is_string() ? text.get<std::string>() : "";
}

std::string name_of(const std::string& folder) {
  const auto path = fs::absolute(folder).lexically_normal();
  return path.filename().empty() ? path.parent_path().filename() : path.filename();
}

std::string phase_text(const Json& progress) {
  std::string phase = text_of(progress, "phase");
  if (phase == "steady")
    return fmt::format("steady {}, 1e{:+.1f} of 1e{:+.0f}", number_of(progress, "iteration"),
                       -number_of(progress, "orders"), -number_of(progress, "of_orders"));
  if (phase == "motion")
    return fmt::format("step {}/{}, alpha {:+.2f}", number_of(progress, "step"),
                       number_of(progress, "of_steps"), number_of(progress, "alpha"));
  return phase;
}

}  // namespace

bool is_run_folder(const std::string& folder) {
  return fs::exists(folder + "/progress.json") || fs::exists(folder + "/result.json") ||
         fs::exists(folder + "/steady.csv");
}

RunView glance_at_run(const std::string& folder) {
  constexpr std::size_t enough = 4096;  // status and message come first
  std::string head(enough, ' ');
  std::ifstream result(folder + "/result.json", std::ios::binary);
  if (!result || fs::exists(folder + "/progress.json")) return view_run(folder);
  result.read(head.data(), enough);
  RunView out;
  out.name = name_of(folder);
  out.state = string_at(head, "status");
  out.message = string_at(head, "message");
  return out.state.empty() ? view_run(folder) : out;
}

RunView view_run(const std::string& folder) {
  RunView out;
  out.name = name_of(folder);
  const std::string progress_file = folder + "/progress.json";
  const Json progress = read_json(progress_file);
  const Json result = read_json(folder + "/result.json");
  if (progress.is_object()) {
    out.state = "running";
    out.title = text_of(progress, "title");
    out.phase = phase_text(progress);
    out.loads = loads_text(progress);
    out.derivatives = derivatives_text(progress.value("derivatives", Json::object()));
    out.silence = seconds_since_written(progress_file);
    if (const Real left = number_of(progress, "seconds_left"); std::isfinite(left))
      out.left = duration_text(left) + (text_of(progress, "phase") == "steady" ? " to the steady state" : "");
  } else if (result.is_object()) {
    out.state = text_of(result, "status");
    out.title = text_of(result, "title");
    out.message = text_of(result, "message");
    out.loads = loads_text(result.value("forces", Json::object()));
    out.derivatives = derivatives_text(result.value("derivatives", Json::object()));
    if (!out.derivatives.empty())
      out.derivatives += fmt::format("  (+-: {})", text_of(result, "uncertainty"));
  } else if (is_run_folder(folder)) {
    out.state = "running";  // its first lines are still to come
    out.silence = seconds_since_written(folder + "/steady.csv");
  }
  out.residuals = residual_row(folder);
  out.moments = moment_row(folder);
  return out;
}

}  // namespace alphadot
