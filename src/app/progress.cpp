#include "app/progress.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/log.hpp"

namespace alphadot {

namespace {
constexpr Real seconds_between_lines = 2;
}

std::string duration_text(Real seconds) {
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
  if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} s", whole);
}

bool ProgressLines::is_due() {
  if (clock_.wall() - last_shown_ < seconds_between_lines) return false;
  last_shown_ = clock_.wall();
  return true;
}

void ProgressLines::show(const SteadyProgress& progress) {
  if (!is_due() && progress.orders < settings_.steady.orders) return;
  const auto loads = coefficients(progress.report.total, settings_);
  const Real share = std::max(progress.orders, Real{0.05}) / settings_.steady.orders;
  spdlog::info("steady {:5}  residual 1e{:+06.2f}  CFL {:.0e}  CN {:+.6f}  CA {:.6f}  Cm {:+.6f}  left {}",
               progress.iteration, -progress.orders, progress.cfl, loads.CN, loads.CA, loads.Cm,
               duration_text(clock_.wall() * (1 / share - 1)));
}

void ProgressLines::show(const StepReport& step, int steps) {
  if (!is_due() && step.step < steps) return;
  const auto loads = coefficients(step.report.total, settings_);
  spdlog::info(
      "step {:4}/{}  alpha {:+.3f}  inner {:3} (1e{:+.1f})  CN {:+.6f}  Cm {:+.6f} +- {:.1e}  left {}",
      step.step, steps, step.attitude.alpha / radians_per_degree, step.inner_iterations, -step.inner_orders,
      loads.CN, loads.Cm, std::abs(coefficients(step.error, settings_).Cm),
      duration_text(clock_.wall() * (static_cast<Real>(steps) / step.step - 1)));
}

}  // namespace alphadot
