// A program of somebody who calls the library, without a command line, a case file or a run's folder: the
// steady flow over the cube of the tests, its normal force, and what that is differentiated by alpha, from a
// linear solve and from an adjoint. usage: consumer MESH
#include <cstdio>

#include "derivatives/adjoint_derivatives.hpp"
#include "derivatives/linear_derivatives.hpp"
#include "derivatives/loads.hpp"

using namespace alphadot;

int main(int argc, char** argv) {
  const MpiSession mpi(argc, argv);
  const Communicator world;
  Case settings;
  settings.mesh.file = argv[1];
  settings.freestream = {.mach = 2, .alpha = 1};
  settings.boundary = {
      {"wall", BoundaryKind::wall}, {"sides", BoundaryKind::symmetry}, {"farfield", BoundaryKind::farfield}};

  FlowCase flow(settings, world);
  const RunStatus status = flow.march();
  const auto loads = coefficients(flow.steady_report().total, settings);
  Responses responses;
  const auto forward = linear_derivatives(flow, responses).estimated;
  AdjointDerivatives adjoint(flow, {parse_functional("CN", "", settings, components_of(settings))});
  Adjoints adjoints;
  adjoint.solve(adjoints);
  std::vector<std::string> shortfalls;
  const auto rows = adjoint.rows(adjoints, shortfalls);
  if (world.is_root())
    std::printf("%s CN %.9f CN_alpha %.9f %s %.9f\n", to_string(status).c_str(), loads.CN,
                forward.at(Variable::alpha).CN.value, rows.front().name.c_str(), rows.front().value.value);
  return exit_code(status);
}
