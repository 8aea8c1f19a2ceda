// A case set up for computing: what the verbs that solve the flow have in common.
#pragma once

#include <string>
#include <vector>

#include "analysis/coefficients.hpp"
#include "app/setup.hpp"
#include "app/verbs.hpp"
#include "core/timer.hpp"
#include "io/result.hpp"
#include "solver/steady.hpp"

namespace alphadot {

/// Mesh, solver and steady flow of one case on this rank.
class FlowCase {
 public:
  /// Reads case and mesh, makes the run's folder. Collective. Throws InputError on every rank.
  FlowCase(const CaseArguments& arguments, const Communicator& comm);

  const Case& settings() const { return setup_.settings; }
  const Setup& setup() const { return setup_; }
  const Communicator& communicator() const { return comm_; }
  const std::string& folder() const { return folder_; }
  ImplicitIteration& iteration() { return iteration_; }
  const Motion& motion() const { return motion_; }
  const FlowReport& steady_report() const { return steady_report_; }

  Conditions<Real> conditions() const;
  /// Marches to the steady state with progress lines. Throws DivergedError.
  RunStatus march();
  /// Why the run ended as it did, for the result.
  void set_message(std::string message) { message_ = std::move(message); }

  /// Everything in result.json but derivatives. Collective.
  Result result(RunStatus status) const;
  /// Writes pictures, resolved case and result.json. Collective.
  void write(const Result& result) const;
  /// The closing lines of a run.
  void print(const Result& result) const;

 private:
  std::vector<std::string> excluded_patches() const;
  PerformanceResult performance() const;

  const Communicator& comm_;
  Timer timer_;
  Setup setup_;
  std::string folder_;
  Discretization discretization_;
  ImplicitIteration iteration_;
  Motion motion_;
  FlowReport steady_report_;
  std::string message_;
};

/// The six coefficients with their names.
NamedValues named(const Coefficients& coefficients);

}  // namespace alphadot
