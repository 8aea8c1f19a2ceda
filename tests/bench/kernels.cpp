// Times the solver's kernels on a case and sets them against what the machine can do. Prints JSON.
//
//   mpirun -n RANKS alphadot_bench CASE [KEY=VALUE ...]
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/flops.hpp"
#include "bench/machine.hpp"
#include "case_file/case_file.hpp"
#include "core/error.hpp"
#include "core/timer.hpp"
#include "derivatives/case.hpp"
#include "io/mesh_reader.hpp"
#include "io/partitioned_mesh.hpp"
#include "linear/block_lu_sgs.hpp"
#include "linear/lu_sgs.hpp"
#include "linear/tangent.hpp"
#include "march/implicit_iteration.hpp"
#include "march/steady.hpp"
#include "motion/motion.hpp"

namespace alphadot {
namespace {

using Json = nlohmann::ordered_json;

Case read_case(int argc, char** argv) {
  if (argc < 2) throw InputError("", 0, "no case", "alphadot_bench CASE [KEY=VALUE ...]");
  std::ifstream in(argv[1], std::ios::binary);
  if (!in) throw InputError(argv[1], 0, "cannot be opened");
  return parse_case(std::string(std::istreambuf_iterator<char>(in), {}), argv[1],
                    std::vector<std::string>(argv + 2, argv + argc));
}

Subdomain read_domain(const Case& settings, const Communicator& comm) {
  if (is_hdf5(settings.mesh.file))
    return distribute(read_partitioned_mesh(settings.mesh.file, comm), comm, settings.mesh.scale);
  Mesh mesh;
  comm.on_root([&] { mesh = read_mesh(settings.mesh.file); });
  return distribute(mesh, comm, settings.mesh.scale);
}

Vec3 wind_of(const FreestreamSettings& stream) {
  return wind_velocity(stream.mach, stream.alpha * radians_per_degree, stream.beta * radians_per_degree);
}

std::vector<BoundaryKind> kinds_of(const Case& settings, const Subdomain& domain) {
  std::vector<BoundaryKind> out;
  for (const auto& name : domain.patch_names) out.push_back(settings.boundary.at(name));
  return out;
}

/// Bytes that a second-order residual must move at least when every array passes through the caches once a
/// loop.
Real residual_bytes(const Subdomain& d) {
  const Real cells = d.owned_cells, all = d.total_cells, points = d.owned_points,
             faces = static_cast<Real>(d.faces.size()), uses = static_cast<Real>(d.point_cells.items.size());
  constexpr Real state = 5 * 8, gradient = 15 * 8, sums = 32 * 8;
  const Real cleared = cells * state;
  const Real gathered = points * (4 + 24 + sums) + 4 * uses + all * (state + 24);
  const Real fitted = cells * (16 + 24 + 48 + 8 + state + gradient) + points * (24 + 56 + sums);
  const Real fluxes = faces * (8 + 24 + 24) + all * (24 + state + gradient) + 2 * cells * state;
  return cleared + gathered + fitted + fluxes;
}

/// The same of the tangent for n changes: no extrema, but the derivatives of fluxes and limiter.
Real tangent_bytes(const Subdomain& d, int n) {
  const Real cells = d.owned_cells, all = d.total_cells, points = d.owned_points,
             faces = static_cast<Real>(d.faces.size()), uses = static_cast<Real>(d.point_cells.items.size());
  const Real state = 5 * 8.0 * n, gradient = 3 * state, sums = 4 * state;
  const Real copies = cells * 4 * state;
  const Real gathered = points * (4 + 24 + sums) + 4 * uses + all * (state + 24);
  const Real fitted =
      cells * (16 + 24 + 48 + state + gradient + sizeof(LimiterSlope)) + points * (24 + 56 + sums);
  const Real fluxes =
      faces * (8 + 24 + sizeof(Linearisation::Face)) + all * (24 + state + gradient) + 2 * cells * state;
  return copies + gathered + fitted + fluxes;
}
/// Operations on changes: 7 a variable and use of a point; gradient 87 and limiter 20 a variable of a cell;
/// two products with a matrix, two reconstructions and two sums a face.
Real tangent_flops(const Subdomain& d, int n) {
  const Real faces = static_cast<Real>(d.faces.size()), uses = static_cast<Real>(d.point_cells.items.size());
  return n * (5 * 7 * uses + 5 * (87 + 20) * static_cast<Real>(d.owned_cells) + (100 + 60 + 10) * faces);
}

/// Of one pass over the rows of the block matrix for `systems` right-hand sides, with its share of what comes
/// before and after `passes` of them.
Real sweep_bytes(const Subdomain& d, int systems, Real passes) {
  constexpr Real matrix = 4 * 100 + 16, state = 32, inverse = 100, in = 40, out = 40;
  const Real before_and_after = inverse + in + 3 * state + out;
  return d.owned_cells * (matrix + systems * (3 * state + before_and_after / passes));
}
Real sweep_flops(const Subdomain& d, int systems, Real passes) {
  constexpr Real product = 50;
  return d.owned_cells * systems * (4 * product + 20 + product / passes);
}

/// Iterations that put the shocks in place: limiter and fluxes then take the branches that they take in
/// earnest.
constexpr int warm_up = 40;
/// Iterations between linearisations, as in the steady march once the flow changes little.
constexpr int jacobian_age = 10;
constexpr Real block_cfl = 1e4, matrix_free_cfl = 50;

int pairs_of(const Case& settings) {
  return settings.steady.sweeps > 0 ? settings.steady.sweeps
                                    : pass_pairs(pass_order(wind_of(settings.freestream).x), true);
}

class Bench {
 public:
  Bench(const Case& settings, const Communicator& comm)
      : settings_(settings),
        comm_(comm),
        domain_(read_domain(settings, comm)),
        discretization_(domain_, kinds_of(settings, domain_), settings.space, settings.freestream.gamma),
        iteration_(discretization_, comm,
                   std::make_unique<BlockLuSgs>(discretization_, comm, settings.steady.sweeps,
                                                pass_order(wind_of(settings.freestream).x)),
                   settings.reference.moment_center) {
    conditions_ = steady_conditions(wind_of(settings.freestream), {}, settings.freestream.gamma);
    develop(iteration_, block_cfl);
  }

  Json results() {
    bandwidth_ = triad_bandwidth(comm_);
    peak_ = peak_flops(comm_);
    const auto message = message_cost(comm_);
    // Before several right-hand sides are solved together, which takes memory of its own.
    const Json iterations{iteration("block LU-SGS", iteration_, block_cfl), matrix_free_iteration()};
    const auto operations = residual_operations(discretization_, comm_, iteration_.flow(), conditions_);
    Json kernels = Json::array();
    kernels.push_back(residual(operations));
    kernels.push_back(sweep(1));
    kernels.push_back(sweep(3));
    kernels.push_back(tangent<1>());
    kernels.push_back(tangent<3>());
    const Real cells = static_cast<Real>(domain_.global_cells);
    return {
        {"ranks", comm_.size()},
        {"cells", domain_.global_cells},
        {"ghost_fraction", comm_.sum(static_cast<Real>(domain_.total_cells - domain_.owned_cells)) / cells},
        {"triad_bytes_per_s", comm_.sum(bandwidth_)},
        {"peak_flops", comm_.sum(peak_)},
        {"latency_s", message.latency},
        {"message_bytes_per_s", message.bandwidth},
        {"reduction_s", reduction_seconds(comm_)},
        {"kernels", kernels},
        {"iterations", iterations}};
  }

 private:
  /// Seconds of processor that the fastest run took, on the rank where it took most, waiting for halos
  /// included.
  Real seconds(int repeats, const std::function<void()>& work) const {
    work();
    Real best = 1e300;
    for (int repeat = 0; repeat < repeats; ++repeat) {
      comm_.barrier();
      const Timer time;
      work();
      best = std::min(best, comm_.max(time.cpu()));
    }
    return best;
  }

  Json kernel(const std::string& name, Real time, Real bytes, Real flops) const {
    const Real cells = static_cast<Real>(domain_.global_cells), ranks = comm_.size();
    const Real by_bytes = bytes / bandwidth_, by_flops = flops / peak_;
    const Real per_cell = 1e9 * ranks / cells;  // ns of a core a cell
    return {{"name", name},
            {"bytes_per_cell", comm_.sum(bytes) / cells},
            {"flops_per_cell", comm_.sum(flops) / cells},
            {"core_ns_per_cell", per_cell * time},
            {"bandwidth_limit_ns", per_cell * comm_.max(by_bytes)},
            {"flop_limit_ns", per_cell * comm_.max(by_flops)},
            {"times_bandwidth_limit", time / comm_.max(by_bytes)}};
  }

  void develop(ImplicitIteration& iteration, Real cfl) const {
    iteration.set_uniform(conditions_.free_stream);
    SteadySettings settings;
    settings.cfl_max = cfl;
    settings.max_iterations = warm_up;
    march_to_steady(iteration, conditions_, settings, 2, [](const SteadyProgress&) { return true; });
  }

  /// An iteration with its share of a linearisation, that linearisation alone, and the bytes of all arrays.
  Json iteration(const std::string& name, ImplicitIteration& iteration, Real cfl) const {
    const Real cells = static_cast<Real>(domain_.global_cells), per_cell = 1e9 * comm_.size() / cells;
    const Real linearisation = seconds(3, [&] { iteration.linearise(conditions_, {.cfl = cfl}); });
    const Real all = seconds(3, [&] {
      iteration.linearise(conditions_, {.cfl = cfl});
      for (int i = 0; i < jacobian_age; ++i) {
        iteration.advance();
        iteration.evaluate(conditions_, 2);
        if (!iteration.report().physical) throw InputError("", 0, name + ": the march has diverged");
      }
    });
    return {{"name", name},
            {"core_ns_per_cell", per_cell * all / jacobian_age},
            {"linearisation_ns_per_cell", per_cell * linearisation},
            {"held_bytes_per_cell", comm_.sum(static_cast<Real>(iteration.bytes())) / cells}};
  }

  Json matrix_free_iteration() const {
    ImplicitIteration matrix_free(discretization_, comm_, std::make_unique<LuSgs>(discretization_, comm_),
                                  settings_.reference.moment_center);
    develop(matrix_free, matrix_free_cfl);
    return iteration("matrix-free LU-SGS", matrix_free, matrix_free_cfl);
  }

  Json residual(const Operations& operations) {
    const Real time = seconds(20, [&] { iteration_.evaluate(conditions_, 2); });
    return kernel("residual", time, residual_bytes(domain_), static_cast<Real>(operations.flops()));
  }

  Json sweep(int count) {
    std::vector<std::vector<Primitive<Real>>> updates(
        static_cast<std::size_t>(count),
        std::vector<Primitive<Real>>(static_cast<std::size_t>(domain_.owned_cells)));
    std::vector<LinearSystem> systems;
    for (auto& update : updates) systems.push_back({iteration_.residual_values(), update});
    const Real passes = 2 * pairs_of(settings_);
    const Real time = seconds(10, [&] { iteration_.linear_solver().solve(systems); }) / passes;
    return kernel(count == 1 ? "sweep" : fmt::format("sweep of {}", count), time,
                  sweep_bytes(domain_, count, passes), sweep_flops(domain_, count, passes));
  }

  template <int N>
  Json tangent() {
    const auto cells = static_cast<std::size_t>(domain_.owned_cells);
    std::array<std::vector<Primitive<Real>>, N> fields;
    std::array<std::vector<Conserved<Real>>, N> images;
    typename Tangent<N>::Fields in;
    typename Tangent<N>::Images out;
    for (std::size_t k = 0; k < N; ++k) {
      fields[k].resize(cells);
      images[k].resize(cells);
      in[k] = fields[k];
      out[k] = images[k];
    }
    const Linearisation linearisation(discretization_, comm_, iteration_.flow(),
                                      iteration_.residual().reconstruction(), conditions_);
    Tangent<N> tangent(linearisation, {});
    const Real time = seconds(10, [&] { tangent.apply(in, {}, out); });
    return kernel(fmt::format("tangent of {}", N), time, tangent_bytes(domain_, N),
                  tangent_flops(domain_, N));
  }

  Case settings_;
  const Communicator& comm_;
  Subdomain domain_;
  Discretization discretization_;
  ImplicitIteration iteration_;
  Conditions<Real> conditions_;
  Real bandwidth_ = 0, peak_ = 0;
};

}  // namespace
}  // namespace alphadot

int main(int argc, char** argv) {
  using namespace alphadot;
  const MpiSession mpi(argc, argv);
  const Communicator comm;
  try {
    Case settings;
    comm.on_all([&] { settings = read_case(argc, argv); });
    const auto results = Bench(settings, comm).results();
    if (comm.is_root()) std::puts(results.dump(2).c_str());
    return 0;
  } catch (const InputError& error) {
    if (comm.is_root()) fmt::print(stderr, "alphadot_bench: error: {}\n", error.what());
    return 1;
  }
}
