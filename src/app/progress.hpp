// Lines that show a long run at work.
#pragma once

#include "app/loads.hpp"
#include "core/timer.hpp"
#include "solver/dual_time.hpp"
#include "solver/steady.hpp"

namespace alphadot {

/// Writes a line now and then: residual, coefficients, time left. Silent on ranks other than the root (the
/// log's level).
class ProgressLines {
 public:
  explicit ProgressLines(const Case& settings) : settings_(settings) {}

  void show(const SteadyProgress& progress);
  void show(const StepReport& step, int steps);

 private:
  bool is_due();

  const Case& settings_;
  Timer clock_;
  Real last_shown_ = -1e9;
};

/// "1 h 02 min", "3 min 20 s", "12 s".
std::string duration_text(Real seconds);

}  // namespace alphadot
