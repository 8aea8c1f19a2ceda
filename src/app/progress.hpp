// What a run shows of itself while it works.
#pragma once

#include <optional>
#include <string>

#include "analysis/residual_forecast.hpp"
#include "analysis/table.hpp"
#include "core/timer.hpp"
#include "derivatives/case.hpp"
#include "io/history.hpp"
#include "io/live_table.hpp"
#include "io/result.hpp"
#include "march/dual_time.hpp"
#include "march/steady.hpp"

namespace alphadot {

/// A line in the terminal now and then, with residual, coefficients, derivatives so far and the time that is
/// left, of a motion, or to the steady state, where it is known. In the
/// run's folder, for whoever looks on from outside (the verb watch, scripts/sweep.py): the same as
/// progress.json, a row an iteration in steady.csv, a row a step in history.csv. None of these is needed to
/// go on, so that one that cannot be written stops nothing. Silent on ranks other than the root.
class Progress {
 public:
  Progress(const Case& settings, const Origin& origin, std::string folder, bool is_root);
  /// Removes progress.json: a run that has ended is known by its result.json.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// The steady march sets out after some iteration; rows of steady.csv up to it are kept.
  void begin_steady(int iteration);
  void show(const SteadyProgress& progress);

  /// The motion sets out after what is recorded already.
  void begin_motion(const History& so_far, int steps);
  /// To be called when the step is in the history.
  void show(const StepReport& step, const History& so_far);

  /// A phase that shows nothing but its name: linear solves, work on another mesh.
  void begin_phase(const std::string& name);

 private:
  bool is_due();
  /// Seconds for the rest of a motion, when `share` of it is done.
  Real seconds_left(Real share) const;
  void begin(Real share);
  void write_json(const std::string& phase, const NamedValues& values, Real seconds_left,
                  std::span<const TableRow> derivatives) const;

  const Case& settings_;
  std::string steady_head_;
  std::string folder_;
  bool is_root_;
  int steps_ = 0;
  std::optional<LiveTable> table_;
  Timer clock_;           ///< of the phase
  Real first_share_ = 0;  ///< of the motion that was done when it began here
  ResidualForecast forecast_;
  Real last_shown_ = -1e9;
};

/// "1 h 02 min", "3 min 20 s", "12 s".
std::string duration_text(Real seconds);

}  // namespace alphadot
