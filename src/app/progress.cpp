#include "app/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "core/csv.hpp"
#include "core/log.hpp"
#include "derivatives/extraction.hpp"
#include "derivatives/loads.hpp"
#include "io/files.hpp"

namespace alphadot {

namespace {

namespace fs = std::filesystem;

constexpr Real seconds_between_lines = 2;
constexpr char steady_columns[] = "iteration,orders,cfl,CA,CY,CN,Cl,Cm,Cn";

/// The head of a table of iterations and the rows up to one of them that the table has so far.
std::string rows_up_to(const std::string& path, const std::string& head, int iteration) {
  std::istringstream in(content_of(path));
  std::string out = head, line;
  while (std::getline(in, line) && line.starts_with('#')) continue;
  if (line != steady_columns) return out;
  while (std::getline(in, line) && std::atoi(line.c_str()) <= iteration) out += line + '\n';
  return out;
}

/// The moment that answers a motion.
const char* moment_of(MotionKind kind) {
  switch (kind) {
    case MotionKind::roll:
      return "Cl_";
    case MotionKind::sway:
    case MotionKind::yaw:
      return "Cn_";
    default:
      return "Cm_";
  }
}

/// "  Cm_alpha -17.05  Cm_alphadot -22.61"
std::string moments_text(std::span<const TableRow> rows, MotionKind kind) {
  std::string out;
  for (const TableRow& row : rows)
    if (row.name.starts_with(moment_of(kind))) out += fmt::format("  {} {:+.4g}", row.name, row.value.value);
  return out;
}

}  // namespace

std::string duration_text(Real seconds) {
  const auto whole = std::lround(seconds);
  if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
  if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} s", whole);
}

Progress::Progress(const Case& settings, const Origin& origin, std::string folder, bool is_root)
    : settings_(settings),
      steady_head_(csv_comment("Flow: " + origin.text()) + steady_columns + '\n'),
      folder_(std::move(folder)),
      is_root_(is_root) {}

Progress::~Progress() {
  std::error_code ignored;
  if (is_root_) fs::remove(folder_ + "/progress.json", ignored);
}

void Progress::begin(Real share) {
  clock_ = Timer();
  first_share_ = share;
  last_shown_ = -1e9;
  forecast_ = {};
  table_.reset();
}

bool Progress::is_due() {
  if (clock_.wall() - last_shown_ < seconds_between_lines) return false;
  last_shown_ = clock_.wall();
  return true;
}

Real Progress::seconds_left(Real share) const {
  const Real done = std::max(share - first_share_, Real{1e-3});
  return std::max(clock_.wall() * (1 - share) / done, Real{0});
}

void Progress::begin_steady(int iteration) {
  begin(0);
  if (!is_root_) return;
  const std::string path = folder_ + "/steady.csv";
  table_.emplace(path, iteration > 0 ? rows_up_to(path, steady_head_, iteration) : steady_head_);
}

void Progress::show(const SteadyProgress& progress) {
  if (!is_root_) return;
  const auto loads = coefficients(progress.report.total, settings_);
  std::vector<std::string> cells{fmt::format("{}", progress.iteration),
                                 fmt::format("{:.6g}", progress.orders), fmt::format("{:.6g}", progress.cfl)};
  for (int i = 0; i < Coefficients::size(); ++i) cells.push_back(fmt::format("{}", loads[i]));
  table_->append(csv_line(cells));
  forecast_.add(clock_.wall(), progress.orders);
  if (!is_due() && progress.orders < settings_.steady.orders) return;
  const Real left = forecast_.seconds_to(settings_.steady.orders);
  spdlog::info("steady {:5}  residual 1e{:+06.2f}  CFL {:.0e}  CN {:+.6f}  CA {:.6f}  Cm {:+.6f}{}",
               progress.iteration, -progress.orders, progress.cfl, loads.CN, loads.CA, loads.Cm,
               std::isfinite(left) ? "  steady in " + duration_text(left) : "");
  write_json("steady",
             {{"iteration", progress.iteration},
              {"orders", progress.orders},
              {"of_orders", settings_.steady.orders},
              {"CA", loads.CA},
              {"CN", loads.CN},
              {"Cm", loads.Cm}},
             left, {});
}

void Progress::begin_motion(const History& so_far, int steps) {
  steps_ = steps;
  begin(static_cast<Real>(so_far.steps()) / steps);
  if (is_root_) table_.emplace(folder_ + "/history.csv", so_far.csv());
}

void Progress::show(const StepReport& step, const History& so_far) {
  if (!is_root_) return;
  // The first row brings the line of names with it.
  table_->append(so_far.steps() == 1 ? so_far.csv() : so_far.csv_row(so_far.steps() - 1));
  if (!is_due() && step.step < steps_) return;
  const auto loads = coefficients(step.report.total, settings_);
  const Real error = std::abs(coefficients(step.error, settings_).Cm);
  const Real left = seconds_left(static_cast<Real>(step.step) / steps_);
  const Extraction so = derivatives_so_far(so_far);
  const auto rows = rows_of(so.estimated.derivatives, so.method);
  spdlog::info(
      "step {:4}/{}  alpha {:+.3f}  inner {:3} (1e{:+.1f})  CN {:+.6f}  Cm {:+.6f} +- {:.1e}{}  left {}",
      step.step, steps_, step.attitude.alpha / radians_per_degree, step.inner_iterations, -step.inner_orders,
      loads.CN, loads.Cm, error, moments_text(rows, settings_.motion.kind), duration_text(left));
  write_json("motion",
             {{"step", step.step},
              {"of_steps", steps_},
              {"alpha", step.attitude.alpha / radians_per_degree},
              {"inner_iterations", step.inner_iterations},
              {"CA", loads.CA},
              {"CN", loads.CN},
              {"Cm", loads.Cm},
              {"error_Cm", error}},
             left, rows);
}

void Progress::begin_phase(const std::string& name) {
  begin(0);
  if (is_root_) write_json(name, {}, not_measured, {});
}

void Progress::write_json(const std::string& phase, const NamedValues& values, Real seconds_left,
                          std::span<const TableRow> derivatives) const {
  nlohmann::ordered_json json{{"title", settings_.title}, {"phase", phase}, {"seconds_left", seconds_left}};
  for (const auto& [name, value] : values) json[name] = value;
  json["derivatives"] = nlohmann::ordered_json::object();
  for (const TableRow& row : derivatives) json["derivatives"][row.name] = row.value.value;
  const std::string path = folder_ + "/progress.json", temporary = path + ".part";
  std::ofstream(temporary) << json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  std::error_code ignored;
  fs::rename(temporary, path, ignored);
}

}  // namespace alphadot
