// What a run's folder shows to somebody who looks on.
#pragma once

#include <string>

#include "core/types.hpp"

namespace alphadot {

/// The state of a run, read from the files in its folder while it works or afterwards.
struct RunView {
  std::string name;   ///< last part of the folder's path
  std::string title;  ///< of the case
  std::string state;  ///< "running", or the status that it ended with; empty: nothing has run here
  std::string phase;  ///< "steady, 1e-06.1 of 1e-10 in 34 iterations", "step 40/72, alpha 1.5", ...
  std::string message;
  std::string loads;        ///< "CA 0.1421  CN +0.3555  Cm -0.9449"
  std::string derivatives;  ///< the moment's and the normal force's: "Cm_alpha -17.05  Cm_alphadot -22.61"
  std::string residuals;    ///< the march as a row of bars, one decade high and low
  std::string moments;      ///< Cm over the steps of the motion, likewise
  std::string left;         ///< time left, "3 min 20 s"; empty: not known
  Real silence = 0;         ///< seconds since a running one wrote its progress

  bool is_running() const { return state == "running"; }
};

/// Reads a folder. A file that is missing or not whole leaves its part empty.
RunView view_run(const std::string& folder);

/// The same for a list of thousands: of a run that has ended its name, state and message alone, and no tables
/// of any.
RunView glance_at_run(const std::string& folder);

/// Whether a folder holds files of a run.
bool is_run_folder(const std::string& folder);

}  // namespace alphadot
