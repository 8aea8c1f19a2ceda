#include "case_file/case_keys.hpp"

#include <fmt/format.h>

#include "case_file/case_values.hpp"

namespace alphadot {
namespace {

/// Adds keys of one settings structure of the case under the name of its table.
template <class Settings>
class Table {
 public:
  Table(std::vector<CaseKey>& keys, std::string name, Settings Case::*settings)
      : keys_(keys), name_(std::move(name)), settings_(settings) {}

  template <class T, class ValueType>
  Table& key(const std::string& name, T Settings::*member, ValueType type, const std::string& doc) {
    const auto at = [ settings = settings_, member ](auto& c) -> auto& {
      return c.*settings.*member;
    };
    keys_.push_back(make_case_key(name_ + "." + name, at, type, doc));
    return *this;
  }
  Table& required() {
    keys_.back().required = true;
    return *this;
  }
  Table& default_is(const std::string& note) {
    keys_.back().default_note = note;
    return *this;
  }

 private:
  std::vector<CaseKey>& keys_;
  std::string name_;
  Settings Case::*settings_;
};
template <class Settings>
Table(std::vector<CaseKey>&, const char*, Settings FlightCondition::*) -> Table<Settings>;

/// reference.model: is the mesh the half y >= 0?
constexpr Word<bool> model_words[] = {{"full", false}, {"half", true}};

/// [boundary]: patch = "treatment", for any name of a patch.
CaseKey boundary_key() {
  const WordValue<BoundaryKind> kind{words_of<BoundaryKind>};
  CaseKey key;
  key.path = "boundary.*";
  key.type = kind.type();
  key.doc = "treatment of the patch of that name in the mesh (sting and jet are left out of the forces)";
  key.required = true;
  key.is_text = true;
  key.read = [kind](std::string_view patch, const toml::node& value, Case& c) {
    return kind.read(value, c.boundary[std::string(patch)]);
  };
  key.write = [kind](const Case& c) {
    std::string lines;
    for (const auto& [patch, treatment] : c.boundary)
      lines += fmt::format("{} = {}\n", toml_string(patch), kind.write(treatment));
    return lines;
  };
  return key;
}

/// [components]: name = ["wall", ...], for any name.
CaseKey components_key() {
  const TextsValue walls{.most = 1000};
  CaseKey key;
  key.path = "components.*";
  key.type = walls.type();
  key.doc = "walls whose loads and derivatives are wanted together, beside those of each by itself";
  key.read = [walls](std::string_view name, const toml::node& value, Case& c) {
    std::vector<std::string> patches;
    auto problem = walls.read(value, patches);
    if (!problem) c.components[std::string(name)] = std::move(patches);
    return problem;
  };
  key.write = [walls](const Case& c) {
    std::string lines;
    for (const auto& [name, patches] : c.components)
      lines += fmt::format("{} = {}\n", toml_string(name), walls.write(patches));
    return lines;
  };
  return key;
}

/// [control_sets]: name = {control = share, ...}, for any name.
CaseKey control_sets_key() {
  const SharesValue shares{.from = -1000, .to = 1000};
  CaseKey key;
  key.path = "control_sets.*";
  key.type = shares.type();
  key.doc =
      "controls that are deflected together, each by so many rad for one of the set: pitch = {left = 1, "
      "right = -1}";
  key.read = [shares](std::string_view name, const toml::node& value, Case& c) {
    std::map<std::string, Real> found;
    auto problem = shares.read(value, found);
    if (!problem) c.control_sets[std::string(name)] = std::move(found);
    return problem;
  };
  key.write = [shares](const Case& c) {
    std::string lines;
    for (const auto& [name, of_controls] : c.control_sets)
      lines += fmt::format("{} = {}\n", toml_string(name), shares.write(of_controls));
    return lines;
  };
  return key;
}

/// [deflections]: control = degrees.
CaseKey deflections_key() {
  const NumberValue angle{.from = -45, .to = 45};
  CaseKey key;
  key.path = "deflections.*";
  key.type = angle.type();
  key.doc =
      "degrees that a control is deflected by in the steady flow: its walls turn as space.deflection says, "
      "which small angles allow";
  key.limits = CaseKey::Limits{angle.from, angle.to};
  key.read = [angle](std::string_view name, const toml::node& value, Case& c) {
    Real degrees = 0;
    auto problem = angle.read(value, degrees);
    if (!problem) c.deflections[std::string(name)] = degrees;
    return problem;
  };
  key.write = [angle](const Case& c) {
    std::string lines;
    for (const auto& [name, degrees] : c.deflections)
      lines += fmt::format("{} = {}\n", toml_string(name), angle.write(degrees));
    return lines;
  };
  return key;
}

std::vector<CaseKey> make_keys() {
  const auto count = IntegerValue{.from = 1, .to = most_steps};
  const auto none_or_more = IntegerValue{.from = 0, .to = most_steps};
  const auto angle = NumberValue{.from = -180, .to = 180};
  const auto length = NumberValue{.from = 1e-9, .to = 1e9};
  const auto point = VectorValue{.from = -1e12, .to = 1e12};
  const auto cfl = NumberValue{.from = 1e-3, .to = 1e12};

  std::vector<CaseKey> keys;
  keys.push_back(make_case_key(
      "title", [](auto& c) -> auto& { return c.title; }, TextValue{.most = 1000, .may_be_empty = true},
      "what the case is, for people"));
  keys.push_back(make_case_key(
      "controls", [](auto& c) -> auto& { return c.controls; }, ControlsValue{},
      "walls that turn about a hinge, as fins or flaps: derivatives by their deflections; positive by the "
      "right-hand rule about the axis, which points outboard; of a half model the mirror image turns along"));

  Table(keys, "mesh", &Case::mesh)
      .key("file", &MeshSettings::file, TextValue{},
           "mesh, relative to the folder of the case file; or else mesh.from")
      .required()
      .key("from", &MeshSettings::from, TextValue{.may_be_empty = true},
           "in place of mesh.file: a description as alphadot mesh takes it, relative to the folder of the "
           "case "
           "file; its mesh, and the next coarser one for the uncertainty, are made once, kept in meshes/ "
           "beside "
           "it and found again as long as nothing changes that they come from")
      .key("level", &MeshSettings::level, WordValue{words_of<Fineness>},
           "of the mesh that is made from mesh.from")
      .key("scale", &MeshSettings::scale, length, "mesh units to the units of [reference]")
      .key(
          "thin", &MeshSettings::thin, TextsValue{.most = 1000},
          "patches inside the mesh, as of fins without thickness, that become walls with two sides; loads of "
          "such a patch are those of both sides together; in a prepared mesh they are so already")
      .key("aft_jets", &MeshSettings::aft_jets, TextsValue{.most = 1000},
           "walls, as of fins with blunt trailing edges, whose faces within 45 degrees of looking aft become "
           "a jet and so leave the forces: a patch of its own, NAME_aft");

  Table(keys, "reference", &Case::reference)
      .key("length", &ReferenceSettings::length, length, "diameter or chord, for moments and rates")
      .key("area", &ReferenceSettings::area, NumberValue{.from = 1e-18, .to = 1e18},
           "area of the whole configuration, also for a half model")
      .key("moment_center", &ReferenceSettings::moment_center, point, "point about which moments are taken")
      .key("model", &ReferenceSettings::half_model, WordValue<bool>{model_words},
           "half: the mesh is the half y >= 0, forces are doubled");

  Table(keys, "freestream", &Case::freestream)
      .key("mach", &FreestreamSettings::mach, NumberValue{.from = 0.01, .to = 100}, "Mach number")
      .required()
      .key("alpha", &FreestreamSettings::alpha, angle, "angle of attack, degrees")
      .key("beta", &FreestreamSettings::beta, NumberValue{.from = -90, .to = 90},
           "angle of sideslip, degrees")
      .key("gamma", &FreestreamSettings::gamma, NumberValue{.from = 1.01, .to = 5},
           "ratio of specific heats");

  keys.push_back(boundary_key());
  keys.push_back(components_key());
  keys.push_back(control_sets_key());
  keys.push_back(deflections_key());

  Table(keys, "space", &Case::space)
      .key("flux", &SpaceSettings::flux, WordValue{words_of<FluxKind>}, "numerical flux")
      .key("order", &SpaceSettings::order, IntegerValue{.from = 1, .to = 2}, "order of accuracy in space")
      .key("gradient", &SpaceSettings::gradient, WordValue{words_of<GradientKind>}, "gradient of a cell")
      .key("limiter", &SpaceSettings::limiter, WordValue{words_of<LimiterKind>}, "limiter of the gradient")
      .key("limiter_threshold", &SpaceSettings::limiter_threshold, NumberValue{.from = 1e-6, .to = 10},
           "share of a cell's own density, speed of sound and pressure up to which changes pass the limiter")
      .key(
          "freeze_orders", &SpaceSettings::freeze_orders, NumberValue{.from = 0, .to = 16},
          "decades of residual after which the limiter is frozen, or before where the march stalls; 0: never")
      .key("entropy_fix", &SpaceSettings::entropy_fix, NumberValue{.from = 0, .to = 1},
           "Harten's delta as a share of the spectral radius")
      .key("dissipative_lee", &SpaceSettings::dissipative_lee, FlagValue{},
           "first order and Van Leer's flux in the cells behind walls that face aft, in a supersonic stream")
      .key("deflection", &SpaceSettings::deflection, WordValue{words_of<DeflectionKind>},
           "how walls of controls turn, by [deflections] and in linear solves: mesh: the mesh deforms with "
           "them; transpiration: it stays and gas passes their faces as along turned walls, for thin panels "
           "and small angles");

  Table(keys, "steady", &Case::steady)
      .key("scheme", &SteadySettings::scheme, WordValue{words_of<SchemeKind>}, "implicit scheme")
      .key(
          "sweeps", &SteadySettings::sweeps, IntegerValue{.from = 0, .to = 100},
          "pairs of passes of the block scheme; where the flow is supersonic all but one go downstream; 0: 4 "
          "there and in motions, 16 elsewhere")
      .key("krylov_directions", &SteadySettings::krylov_directions, IntegerValue{.from = 0, .to = 1000},
           "at most so many directions a Newton-Krylov step, which is taken where the scheme alone is slow; "
           "0: never")
      .key("cfl_start", &SteadySettings::cfl_start, cfl, "first CFL number")
      .key("cfl_max", &SteadySettings::cfl_max, cfl, "largest CFL number")
      .key("cfl_growth", &SteadySettings::cfl_growth, NumberValue{.from = 1, .to = 100},
           "growth of the CFL number")
      .key("max_iterations", &SteadySettings::max_iterations, count, "limit of iterations")
      .key("orders", &SteadySettings::orders, NumberValue{.from = 0.1, .to = 16},
           "decades that the density residual must drop");

  Table(keys, "motion", &Case::motion)
      .key("kind", &MotionSettings::kind, WordValue{words_of<MotionKind>}, "motion after the steady state")
      .key("treatment", &MotionSettings::treatment, WordValue{words_of<TreatmentKind>},
           "how the motion enters the equations")
      .key("amplitude", &MotionSettings::amplitude, NumberValue{.from = 1e-6, .to = 180},
           "degrees of alpha, theta or phi; for step_q the reduced rate")
      .key("reduced_frequency", &MotionSettings::reduced_frequency, NumberValue{.from = 1e-6, .to = 100},
           "omega * length / (2 V)")
      .key("axis_point", &MotionSettings::axis_point, point, "rotations are about this point")
      .default_is("reference.moment_center")
      .key("table_file", &MotionSettings::table_file, TextValue{.may_be_empty = true},
           "for kind = \"table\", relative to the folder of the case file")
      .key(
          "rotation", &MotionSettings::rotation, VectorValue{.from = -10, .to = 10},
          "(p, q, r) * length / (2 V): for kind = \"none\" steady rotation at constant incidence, for kind = "
          "\"free\" that at the release");

  const auto per_mass = NumberValue{.from = 0, .to = 1e18};
  const auto inertias = VectorValue{.from = 0, .to = 1e18};
  Table(keys, "body", &Case::body)
      .key(
          "free", &BodySettings::free, WordsValue{words_of<FreedomKind>},
          "for motion.kind = \"free\": what the body may do, along axes at rest (x, y, z) and about its own; "
          "all else is held")
      .key("mass", &BodySettings::mass, per_mass,
           "over rho length^3, rho the stream's density; of the whole body, also for a half model")
      .key("inertia", &BodySettings::inertia, inertias,
           "moments about the mesh axes through the centre of gravity, motion.axis_point; over rho length^5")
      .key("products", &BodySettings::products, VectorValue{.from = -1e18, .to = 1e18},
           "of inertia, integrals of x y, x z and y z over the mass, likewise")
      .key("gravity", &BodySettings::gravity, VectorValue{.from = -1e6, .to = 1e6},
           "acceleration along the mesh axes at the release, times length / V^2");

  Table(keys, "gust", &Case::gust)
      .key("kind", &GustSettings::kind, WordValue{words_of<GustKind>},
           "air that moves across the stream, in fronts normal to x, over the distance behind the first")
      .key("velocity", &GustSettings::velocity, NumberValue{.from = -1, .to = 1}, "its largest, over V")
      .key("length", &GustSettings::length, length, "of one_minus_cosine, and one wave of harmonic")
      .key("front", &GustSettings::front, NumberValue{.from = -1e9, .to = 1e9}, "x of its front at t = 0")
      .key("speed", &GustSettings::speed, NumberValue{.from = 0, .to = 10},
           "at which its pattern comes, over the stream's: 1 is at rest in the air, 0 stands")
      .key("direction", &GustSettings::direction, WordValue{words_of<GustDirection>}, "of the moving air")
      .key("table_file", &GustSettings::table_file, TextValue{.may_be_empty = true},
           "for kind = \"table\", columns distance and velocity, relative to the folder of the case file");

  Table(keys, "unsteady", &Case::unsteady)
      .key("cycles", &UnsteadySettings::cycles, NumberValue{.from = 0.01, .to = 1e6},
           "duration of a harmonic motion")
      .key("steps_per_cycle", &UnsteadySettings::steps_per_cycle, IntegerValue{.from = 4, .to = 1'000'000},
           "time steps a cycle")
      .key("duration", &UnsteadySettings::duration, NumberValue{.from = 0, .to = 1e9},
           "t* = 2 V t / length of a step, ramp, table, gust or free flight")
      .key("steps", &UnsteadySettings::steps, none_or_more, "number of time steps in the duration")
      .key("inner_tolerance", &UnsteadySettings::inner_tolerance, NumberValue{.from = 1e-14, .to = 1},
           "change of the out-of-phase moment between inner iterations, relative to it")
      .key("max_inner", &UnsteadySettings::max_inner, IntegerValue{.from = 3, .to = 1'000'000},
           "limit of inner iterations a time step; fewer show no rate to judge them by");

  Table(keys, "derivatives", &Case::derivatives)
      .key("method", &DerivativeSettings::method, WordValue{words_of<SensitivityMethod>},
           "solver of the linear systems: GMRES, or the march of the block scheme")
      .key("orders", &DerivativeSettings::orders, NumberValue{.from = 0.1, .to = 12},
           "decades that the linear residual, scaled cell by cell, must drop")
      .key("directions", &DerivativeSettings::directions, IntegerValue{.from = 2, .to = 1000},
           "of the Krylov space of GMRES before it begins anew; 40 bytes a cell each")
      .key("max_iterations", &DerivativeSettings::max_iterations, count, "limit of linear iterations")
      .key("second_order", &DerivativeSettings::second_order, FlagValue{},
           "also by the second time derivatives of alpha and beta, and where quasi-steady flight ends")
      .key("control_rates", &DerivativeSettings::control_rates, FlagValue{},
           "also by the rates of the controls' deflections, times length / 2V: CN_flapdot")
      .key("limiter_uncertainty", &DerivativeSettings::limiter_uncertainty, FlagValue{},
           "solve once more with the limiter's factors held at those of the steady flow, and add the "
           "difference to the uncertainty; doubles the cost of the linear solves")
      .key("coarser_meshes", &DerivativeSettings::coarser_meshes, TextsValue{.most = 2},
           "the same flow on these meshes too, the finer first, for the part of the mesh in the uncertainty");

  Table(keys, "estimates", &Case::estimates)
      .key("reynolds", &EstimateSettings::reynolds, NumberValue{.from = 0, .to = 1e12},
           "of the free stream and the reference length, for friction beside the forces; 0: no friction")
      .key("transition", &EstimateSettings::transition, NumberValue{.from = 0, .to = 1e12},
           "Reynolds number along each component at which its boundary layer becomes turbulent; 0: from the "
           "start");

  Table(keys, "output", &Case::output)
      .key("folder", &OutputSettings::folder, TextValue{}, "folder of the run")
      .default_is("runs/<name of the case file>")
      .key("flow", &OutputSettings::flow, FlagValue{}, "write flow.vtkhdf")
      .key("surface", &OutputSettings::surface, FlagValue{}, "write surface.vtkhdf and symmetry.vtkhdf")
      .key("stations", &OutputSettings::stations, IntegerValue{.from = 0, .to = 10'000},
           "of the derivatives' distributions along the body and along the panels of controls; 0: none");

  const auto minutes = NumberValue{.from = 0, .to = 1e7};
  Table(keys, "checkpoint", &Case::checkpoint)
      .key("minutes", &CheckpointSettings::minutes, minutes, "wall time between checkpoints; 0: not by time")
      .key("steps", &CheckpointSettings::steps, none_or_more,
           "time steps between checkpoints; 0: not by steps")
      .key("iterations", &CheckpointSettings::iterations, none_or_more,
           "steady iterations between checkpoints; 0: not by iterations")
      .key("keep", &CheckpointSettings::keep, count, "checkpoints that are kept, the newest")
      .key("wall_limit_minutes", &CheckpointSettings::wall_limit_minutes, minutes,
           "the run ends with a checkpoint before this wall time; 0: no limit")
      .key("on_failure", &CheckpointSettings::on_failure, WordValue{words_of<FailureAction>},
           "what a run does whose checkpoint cannot be written")
      .key("watchdog_minutes", &CheckpointSettings::watchdog_minutes, minutes,
           "a run without an iteration for so long is ended as hanging; 0: never");
  return keys;
}

}  // namespace

const std::vector<CaseKey>& case_keys() {
  static const std::vector<CaseKey> keys = make_keys();
  return keys;
}

const CaseKey* find_case_key(std::string_view path) {
  for (const auto& key : case_keys()) {
    const auto table = key.table();
    if (path == key.path && !key.is_family()) return &key;
    if (key.is_family() && path.size() > table.size() && path.starts_with(table)) return &key;
  }
  return nullptr;
}

}  // namespace alphadot
