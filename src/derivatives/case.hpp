// What a run is asked to do: every key of the case file as plain data with its default.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "analysis/axial_force.hpp"
#include "core/words.hpp"
#include "derivatives/settings.hpp"
#include "march/settings.hpp"
#include "motion/flight_condition.hpp"
#include "space/settings.hpp"

namespace alphadot {

/// How fine a mesh is that is made from a description.
enum class Fineness { tiny, coarse, medium, fine };

namespace words {
inline constexpr Word<Fineness> fineness[] = {{"tiny", Fineness::tiny},
                                              {"coarse", Fineness::coarse},
                                              {"medium", Fineness::medium},
                                              {"fine", Fineness::fine}};
}
template <>
inline constexpr std::span<const Word<Fineness>> words_of<Fineness> = words::fineness;

struct MeshSettings {
  std::string file;                        ///< as resolved against the case file's folder
  std::string from;                        ///< in place of the file: a description to make it from
  Fineness level = Fineness::coarse;       ///< of that mesh
  Real scale = 1;                          ///< mesh units to the units of [reference]
  std::vector<std::string> thin = {};      ///< patches inside the mesh that become walls with two sides
  std::vector<std::string> aft_jets = {};  ///< walls whose faces that look aft become jets
};

struct OutputSettings {
  std::string folder;   ///< default: runs/<name of the case file>
  bool flow = true;     ///< write flow.vtkhdf
  bool surface = true;  ///< write surface.vtkhdf
  int stations = 100;   ///< of distributions along the body and along panels; 0: none
};

/// Walls that turn together about a hinge: an all-moving fin, a flap.
struct ControlSettings {
  std::string name;
  std::vector<std::string> patches;
  Vec3 hinge_point;  ///< for a panel, where its hinge line meets its root
  Vec3 hinge_axis;   ///< outboard for a panel; the deflection is positive by the right-hand rule about it

  bool operator==(const ControlSettings& other) const = default;
};

enum class FailureAction { stop, go_on };

namespace words {
inline constexpr Word<FailureAction> failure[] = {{"stop", FailureAction::stop},
                                                  {"continue", FailureAction::go_on}};
}
template <>
inline constexpr std::span<const Word<FailureAction>> words_of<FailureAction> = words::failure;

struct CheckpointSettings {
  Real minutes = 30;            ///< of wall time between checkpoints; 0: not by time
  int steps = 0;                ///< time steps between checkpoints; 0: not by steps
  int iterations = 0;           ///< steady iterations between checkpoints; 0: not by iterations
  int keep = 2;                 ///< the newest that are kept
  Real wall_limit_minutes = 0;  ///< of the whole run: it ends with a checkpoint before; 0: no limit
  FailureAction on_failure = FailureAction::stop;  ///< when a checkpoint cannot be written
  Real watchdog_minutes = 0;  ///< without an iteration that end a run as hanging; 0: never
};

/// Walls by the name of what they form together.
using Components = std::map<std::string, std::vector<std::string>>;

/// A whole case. `boundary` maps the mesh's patch names to their treatment.
struct Case : FlightCondition {
  std::string title;
  std::string file;  ///< path of the case file, for messages
  MeshSettings mesh;
  std::map<std::string, BoundaryKind> boundary;
  /// Sets of walls whose derivatives are wanted, beside those of each wall by itself.
  Components components;
  std::vector<ControlSettings> controls;
  /// Controls deflected together, each by so many rad for one of the set, by the name of the set.
  std::map<std::string, std::map<std::string, Real>> control_sets;
  std::map<std::string, Real> deflections;    ///< of controls in the steady flow, degrees
  std::map<std::string, int> boundary_lines;  ///< where the case file names the patches, for messages
  BodySettings body;
  GustSettings gust;
  SpaceSettings space;
  SteadySettings steady;
  UnsteadySettings unsteady;
  DerivativeSettings derivatives;
  EstimateSettings estimates;
  OutputSettings output;
  CheckpointSettings checkpoint;
};

/// Whether a run goes on in time from the steady flow.
inline bool goes_on_in_time(const Case& c) {
  return c.motion.kind != MotionKind::none || c.gust.kind != GustKind::none;
}

}  // namespace alphadot
