// result.json: what a run has found, for people and programs.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/flight.hpp"
#include "core/run_status.hpp"
#include "io/provenance.hpp"

namespace alphadot {

/// Names and values in the order in which they are shown.
using NamedValues = std::vector<std::pair<std::string, Real>>;

struct DerivativeResult {
  Real value = 0;
  Real uncertainty = 0;
  std::string method;                 ///< "harmonic fit of plunge at k = 0.01", ...
  bool converged = true;              ///< everything that it rests on reached what was asked for
  NamedValues parts = {};             ///< of the uncertainty, by source; may be empty
  NamedValues mesh_convergence = {};  ///< what refinement of the mesh says; may be empty
};

/// Not a number: a figure that was not measured; null in the file.
inline constexpr Real not_measured = std::numeric_limits<Real>::quiet_NaN();

struct PerformanceResult {
  Real wall_s = not_measured;
  Real cpu_s = not_measured;  ///< over all ranks
  Real steady_wall_s = not_measured,
       steady_cpu_s = not_measured;          ///< of these, the march to the steady state
  Real motion_cpu_s = not_measured;          ///< of these, the march along the motion
  Real linear_cpu_s = not_measured;          ///< of these, the linear solves for the derivatives
  Real coarser_meshes_cpu_s = not_measured;  ///< of these, steady states and linear solves on coarser meshes
  std::int64_t checkpoints = 0;              ///< written
  Real checkpoint_wall_s = not_measured,
       checkpoint_cpu_s = not_measured;  ///< of wall_s and cpu_s, the writing of all these checkpoints
  Real restart_wall_s = not_measured,
       restart_cpu_s = not_measured;  ///< the reading and verifying of the one that the run went on from
  std::int64_t iterations = 0;
  Real core_us_per_cell_iteration = not_measured;
  Real bytes_per_cell = not_measured;          ///< of the solver's and the mesh's arrays
  Real mesh_bytes_per_cell = not_measured;     ///< of the mesh's arrays alone
  Real reading_bytes_per_cell = not_measured;  ///< the most in memory at a time while the mesh was read
  Real peak_bytes_per_cell = not_measured;  ///< the most in memory at a time, program and libraries included
  Real busiest_rank_bytes = not_measured;   ///< the same of the rank that held most
  Real halo_fraction = not_measured;        ///< share of the wall time spent waiting for other ranks
  Real halo_bytes_per_iteration = not_measured;     ///< sent by all ranks
  Real most_messages_per_iteration = not_measured;  ///< sent by the rank that sends most
  Real ghost_fraction = not_measured;               ///< ghosts of all ranks over cells
  Real load_imbalance = not_measured;               ///< cells of the largest rank over the mean, less one
};

struct MeshResult {
  std::string file;
  std::int64_t cells = 0, points = 0;
  std::string hash;
};

/// What the mesh is as a configuration: see Configuration in src/space.
struct ConfigurationResult {
  std::vector<std::pair<std::string, std::vector<Real>>> facts;  ///< in the order in which they are shown
  std::vector<std::string> warnings;                             ///< what is improbable about it
};

/// A part of CA that is no result of the flow.
struct EstimateResult {
  Real CA = 0;
  std::string source;
};

struct Result {
  RunStatus status = RunStatus::error;
  std::string message;                   ///< why it ended so; may be empty
  std::vector<std::string> not_reached;  ///< what was asked for and not reached
  std::string title;
  std::string verb;               ///< that asked for it
  std::string case_text;          ///< resolved
  std::string motion_table_hash;  ///< of the table's content; empty: there is none
  MeshResult mesh;
  ConfigurationResult configuration;
  ReferenceSettings reference;
  FreestreamSettings freestream;
  std::string rate = "times length / (2 V)";  ///< how rates are made dimensionless
  /// Of forces and moments.
  std::string axes = "mesh axes x aft, y starboard, z up; Cl Cm Cn about x forward, y starboard, z down";
  NamedValues forces;                               ///< CA CY CN Cl Cm Cn of the whole configuration
  std::map<std::string, NamedValues> components;    ///< the same of walls and sets of walls
  std::map<std::string, NamedValues> one_side;      ///< of a half model: the same without the mirror image
  std::map<std::string, NamedValues> panels;        ///< of controls: loads in the panel's own frame
  std::vector<std::string> excluded;                ///< patches left out of the forces (sting, jet)
  std::map<std::string, EstimateResult> estimates;  ///< by name: of CA, beside the forces
  std::map<std::string, DerivativeResult> derivatives;  ///< by name, "Cm_alphadot"; per radian
  std::string uncertainty;   ///< what those of the derivatives hold; empty: there are none
  NamedValues decay;         ///< of a free flight: its frequency and damping; may be empty
  NamedValues longitudinal;  ///< static margin, neutral point, limits of quasi-steady flight; may be empty
  PerformanceResult performance;
  Provenance provenance;
};

/// The result as JSON text. What is not finite becomes null.
std::string result_json(const Result& result);

/// Reads back what derivatives need: status, message, title, verb, mesh file and hash, reference,
/// free stream, forces of the whole, derivatives without mesh_convergence, uncertainty, version. The rest has
/// its defaults. Not collective: for one rank. Throws InputError when the file is cut, or not a result.
Result read_result(const std::string& path);

/// Writes it as `path` through a temporary file. For one rank; throws InputError.
void write_result(const std::string& path, const Result& result);

}  // namespace alphadot
