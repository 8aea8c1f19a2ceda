// Processor time of the solver's kernels on one core, on the mesh of a case and in its developed flow:
//
//   bench_solver CASE.toml [--benchmark_format=json ...]
//
// Items are cells, so that items_per_second is cells per second of processor time; the iterations also say
// how many bytes per cell their solver holds. scripts/bench.sh runs this and sets it beside the targets.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <memory>

#include "core/error.hpp"
#include "io/case_file.hpp"
#include "io/mesh_reader.hpp"
#include "solver/block_lu_sgs.hpp"
#include "solver/implicit_iteration.hpp"
#include "solver/lu_sgs.hpp"
#include "solver/steady.hpp"

namespace alphadot {
namespace {

/// Iterations that put the shocks in place: limiter and fluxes then take the branches that they take in
/// earnest.
constexpr int warm_up = 40;
/// Iterations between linearisations, as in the steady march once the flow changes little.
constexpr int jacobian_age = 10;
constexpr int block_sweeps = 2;
constexpr Real block_cfl = 1e4, matrix_free_cfl = 50;
constexpr int order = 2;

/// Mesh and free stream of a case on this one rank. Stays where it is: the discretisation refers to the
/// domain.
struct BenchCase {
  explicit BenchCase(const Case& settings)
      : domain(distribute(read_mesh(settings.mesh.file), comm, settings.mesh.scale)),
        discretization(domain, kinds_of(settings, domain), settings.space, settings.freestream.gamma),
        conditions(steady_conditions(
            wind_velocity(settings.freestream.mach, settings.freestream.alpha * radians_per_degree,
                          settings.freestream.beta * radians_per_degree),
            {}, settings.freestream.gamma)) {}
  BenchCase(const BenchCase&) = delete;
  BenchCase& operator=(const BenchCase&) = delete;

  static std::vector<BoundaryKind> kinds_of(const Case& settings, const Subdomain& domain) {
    std::vector<BoundaryKind> out;
    for (const auto& name : domain.patch_names) out.push_back(settings.boundary.at(name));
    return out;
  }

  const Communicator comm;
  const Subdomain domain;
  const Discretization discretization;
  const Conditions<Real> conditions;
};

/// A march with one solver, warmed up.
struct BenchMarch {
  BenchMarch(const BenchCase& bench, std::unique_ptr<LinearSolver> solver, Real pseudo_cfl)
      : conditions(bench.conditions),
        cfl(pseudo_cfl),
        cells(bench.domain.owned_cells),
        iteration(bench.discretization, bench.comm, std::move(solver), {}) {
    iteration.set_uniform(conditions.free_stream);
    SteadySettings settings;
    settings.cfl_max = cfl;
    settings.max_iterations = warm_up;
    march_to_steady(iteration, conditions, settings, order, [](const SteadyProgress&) { return true; });
  }
  /// As many iterations as one linearisation serves, that one included.
  FlowReport advance() {
    iteration.linearise(conditions, {.cfl = cfl});
    FlowReport report;
    for (int i = 0; i < jacobian_age; ++i) {
      iteration.advance();
      iteration.evaluate(conditions, order);
      report = iteration.report();
    }
    return report;
  }

  const Conditions<Real> conditions;
  const Real cfl;
  const Index cells;
  ImplicitIteration iteration;
};

void residual(benchmark::State& state, BenchMarch& march) {
  for (auto _ : state) {
    march.iteration.evaluate(march.conditions, order);
    benchmark::DoNotOptimize(march.iteration.residual_values().data());
  }
  state.SetItemsProcessed(state.iterations() * march.cells);
}

void linearisation(benchmark::State& state, BenchMarch& march) {
  for (auto _ : state) march.iteration.linearise(march.conditions, {.cfl = march.cfl});
  state.SetItemsProcessed(state.iterations() * march.cells);
}

void iteration(benchmark::State& state, BenchMarch& march) {
  FlowReport report;
  for (auto _ : state) report = march.advance();
  if (!report.physical) state.SkipWithError("the march has diverged");
  state.SetItemsProcessed(state.iterations() * march.cells * jacobian_age);
  state.counters["bytes_per_cell"] = static_cast<Real>(march.iteration.bytes()) / march.cells;
}

void run(const std::string& case_file) {
  const BenchCase bench(read_case(case_file));
  BenchMarch block(bench, std::make_unique<BlockLuSgs>(bench.discretization, bench.comm, block_sweeps),
                   block_cfl);
  BenchMarch matrix_free(bench, std::make_unique<LuSgs>(bench.discretization, bench.comm), matrix_free_cfl);
  const auto add = [](const char* name, void (*function)(benchmark::State&, BenchMarch&), BenchMarch& march) {
    benchmark::RegisterBenchmark(name, function, std::ref(march))->Unit(benchmark::kMillisecond);
  };
  add("residual", residual, block);
  add("block_linearisation", linearisation, block);
  add("block_lu_sgs_iteration", iteration, block);
  add("lu_sgs_iteration", iteration, matrix_free);
  benchmark::AddCustomContext("cells", std::to_string(bench.domain.global_cells));
  benchmark::RunSpecifiedBenchmarks();
}

}  // namespace
}  // namespace alphadot

int main(int argc, char** argv) {
  const alphadot::MpiSession mpi(argc, argv);
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    fmt::print(stderr, "usage: {} CASE.toml [--benchmark_...]\n", argv[0]);
    return 2;
  }
  try {
    alphadot::run(argv[1]);
  } catch (const alphadot::InputError& error) {
    for (const auto& problem : error.problems()) fmt::print(stderr, "bench_solver: {}\n", problem.text());
    return 1;
  }
  return 0;
}
