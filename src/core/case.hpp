// What a run is asked to do: every key of the case file as plain data with its default.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "core/vec3.hpp"

namespace alphadot {

enum class FluxKind { roe, van_leer, hllc };
enum class GradientKind { least_squares, green_gauss };
enum class LimiterKind { venkatakrishnan, mlp_u2, barth_jespersen, none };
enum class SchemeKind { lu_sgs, block_lu_sgs };
enum class SensitivityMethod { gmres, march };
enum class MotionKind { none, plunge, sway, pitch, yaw, roll, flap, step_alpha, ramp_alpha, step_q, table };
enum class TreatmentKind { field_velocity, rigid_grid, deforming_grid };

/// How a patch of the boundary is treated.
/// wall: slip wall, counted in the forces. sting: slip wall left out of the forces. base_jet ("jet"): imposes
/// the free stream, left out of the forces. symmetry: slip plane. farfield: characteristic.
enum class BoundaryKind { wall, sting, jet, symmetry, farfield };

struct MeshSettings {
  std::string file;  ///< as resolved against the case file's folder
  Real scale = 1;    ///< mesh units to the units of [reference]
};

struct ReferenceSettings {
  Real length = 1;          ///< d (or c): makes moments and rates dimensionless
  Real area = 1;            ///< S of the whole configuration, also for a half model
  Vec3 moment_center;       ///< point about which moments are taken
  bool half_model = false;  ///< the mesh is the half y >= 0: forces are doubled, CY, Cl and Cn are zero
};

struct FreestreamSettings {
  Real mach = 0;
  Real alpha = 0;  ///< degrees
  Real beta = 0;   ///< degrees
  Real gamma = 1.4;
};

struct SpaceSettings {
  FluxKind flux = FluxKind::roe;
  int order = 2;
  GradientKind gradient = GradientKind::least_squares;
  LimiterKind limiter = LimiterKind::venkatakrishnan;
  /// Share of a cell's own density, speed of sound and pressure up to which changes pass the limiter.
  Real limiter_threshold = 0.2;
  /// Decades of residual after which the limiter is frozen; before, where the march stalls; 0: never. The
  /// flow that it is frozen at depends on the way there, which one that came to rest does not.
  Real freeze_orders = 16;
  Real entropy_fix = 0.1;  ///< Harten's delta as a share of the spectral radius
};

struct SteadySettings {
  SchemeKind scheme = SchemeKind::block_lu_sgs;
  int sweeps = 4;             ///< pairs of passes of the block scheme
  int krylov_directions = 0;  ///< of GMRES around the scheme; 0: the scheme alone
  Real cfl_start = 20;
  Real cfl_max = 1000;  ///< larger ones save little, and flow around fins at high incidence stands no more
  Real cfl_growth = 2;
  int max_iterations = 2000;
  Real orders = 10;  ///< decades that the density residual must drop
};

struct MotionSettings {
  MotionKind kind = MotionKind::none;
  TreatmentKind treatment = TreatmentKind::field_velocity;
  Real amplitude = 1;             ///< degrees of alpha, theta or phi; for step_q the reduced rate
  Real reduced_frequency = 0.01;  ///< omega * length / (2 V)
  Vec3 axis_point;                ///< rotations are about this point
  std::string table_file;         ///< for kind = "table"
  Vec3 rotation{};                ///< steady (p, q, r) * length / (2 V) at constant incidence, kind none only
};

struct UnsteadySettings {
  Real cycles = 1.5;  ///< duration of a harmonic motion
  int steps_per_cycle = 48;
  Real duration = 0;  ///< t* = 2 V t / length; of a step, ramp or table
  int steps = 0;      ///< number of steps in `duration`
  Real inner_tolerance =
      1e-3;  ///< change of the out-of-phase moment between inner iterations, relative to it
  int max_inner = 100;
};

/// How the linear systems behind the stability derivatives are solved.
struct DerivativeSettings {
  SensitivityMethod method = SensitivityMethod::gmres;
  Real orders = 3;      ///< decades that the residual must drop
  int directions = 80;  ///< of the Krylov space before it begins anew
  int max_iterations = 300;
  bool second_order = false;         ///< also with respect to the second time derivatives of alpha and beta
  bool limiter_uncertainty = false;  ///< solve once more with the limiter's factors held
  std::vector<std::string> coarser_meshes = {};  ///< at most two, the finer first; as mesh.file
};

struct OutputSettings {
  std::string folder;   ///< default: runs/<name of the case file>
  bool flow = true;     ///< write flow.vtkhdf
  bool surface = true;  ///< write surface.vtkhdf
};

enum class FailureAction { stop, go_on };

struct CheckpointSettings {
  Real minutes = 30;            ///< of wall time between checkpoints; 0: not by time
  int steps = 0;                ///< time steps between checkpoints; 0: not by steps
  int iterations = 0;           ///< steady iterations between checkpoints; 0: not by iterations
  int keep = 2;                 ///< the newest that are kept
  Real wall_limit_minutes = 0;  ///< of the whole run: it ends with a checkpoint before; 0: no limit
  FailureAction on_failure = FailureAction::stop;  ///< when a checkpoint cannot be written
  Real watchdog_minutes = 0;  ///< without an iteration that end a run as hanging; 0: never
};

/// A whole case. `boundary` maps the mesh's patch names to their treatment.
struct Case {
  std::string title;
  std::string file;  ///< path of the case file, for messages
  MeshSettings mesh;
  ReferenceSettings reference;
  FreestreamSettings freestream;
  std::map<std::string, BoundaryKind> boundary;
  std::map<std::string, int> boundary_lines;  ///< where the case file names the patches, for messages
  SpaceSettings space;
  SteadySettings steady;
  MotionSettings motion;
  UnsteadySettings unsteady;
  DerivativeSettings derivatives;
  OutputSettings output;
  CheckpointSettings checkpoint;
};

}  // namespace alphadot
