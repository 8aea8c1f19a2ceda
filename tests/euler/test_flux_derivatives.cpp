// Derivatives of the fluxes carried by dual numbers, against central differences and exact identities.
#include <gtest/gtest.h>

#include <array>

#include "core/dual.hpp"
#include "euler/kinds.hpp"
#include "samples.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

class FluxDerivative : public testing::TestWithParam<FluxKind> {
 protected:
  /// Left state, right state, grid speed.
  using Inputs = std::array<Real, 11>;

  Inputs draw() {
    const auto left = samples.state(2, 1.5), right = samples.state(2, 1.5);
    Inputs x;
    for (int i = 0; i < 5; ++i) {
      x[i] = left[i];
      x[5 + i] = right[i];
    }
    x[10] = samples.between(-1, 1);
    return x;
  }
  template <class T>
  Conserved<T> flux(const std::array<T, 11>& x, const Vec3& normal) const {
    Primitive<T> left, right;
    for (int i = 0; i < 5; ++i) {
      left[i] = x[i];
      right[i] = x[5 + i];
    }
    return numerical_flux(model, left, right, normal, x[10]);
  }
  /// Derivative of the flux along a direction in the space of inputs.
  Conserved<Real> derivative(const Inputs& at, const Inputs& direction, const Vec3& normal) const {
    std::array<Dual<1>, 11> x;
    for (int i = 0; i < 11; ++i) {
      x[i].v = at[i];
      x[i].d[0] = direction[i];
    }
    const auto dual = flux(x, normal);
    Conserved<Real> out;
    for (int i = 0; i < 5; ++i) out[i] = dual[i].d[0];
    return out;
  }

  const FluxModel model{GetParam(), gamma_air, 0.1};
  Samples samples{51};
};
INSTANTIATE_TEST_SUITE_P(Fluxes, FluxDerivative, testing::ValuesIn(all_fluxes),
                         [](const auto& kind) { return name_of(kind.param); });

// Central differences of step 1e-5 err by step^2 f''' (1e-10) and by round-off / step (1e-10 of fluxes up to
// ten).
TEST_P(FluxDerivative, AgreesWithCentralDifferences) {
  constexpr Real step = 1e-5;
  for (int i = 0; i < 200; ++i) {
    const Inputs at = draw();
    const Vec3 normal = samples.direction();
    std::array<Dual<11>, 11> x;
    for (int k = 0; k < 11; ++k) {
      x[k].v = at[k];
      x[k].d[k] = 1;
    }
    const auto dual = flux(x, normal);
    const auto plain = flux(at, normal);
    for (int row = 0; row < 5; ++row) EXPECT_NEAR(dual[row].v, plain[row], 1e-13 * (1 + largest(plain)));
    for (int k = 0; k < 11; ++k) {
      Inputs above = at, below = at;
      above[k] += step;
      below[k] -= step;
      const auto difference = (0.5 / step) * (flux(above, normal) - flux(below, normal));
      for (int row = 0; row < 5; ++row)
        EXPECT_NEAR(dual[row].d[k], difference[row], 1e-7 * (1 + largest(difference)))
            << "row " << row << " input " << k;
    }
  }
}

// Euler's theorem: the flux is homogeneous of degree one in the densities and pressures together.
TEST_P(FluxDerivative, GivesBackTheFluxAlongDensityAndPressure) {
  for (int i = 0; i < 200; ++i) {
    const Inputs at = draw();
    const Vec3 normal = samples.direction();
    Inputs direction{};
    for (const int k : {0, 4, 5, 9}) direction[k] = at[k];
    const auto expected = flux(at, normal);
    expect_near(derivative(at, direction, normal), expected, 1e-12 * (1 + largest(expected)));
  }
}

// Faster by s dt in both states and the face: the mass flux stays, momentum gains s mass, energy s.momentum.
TEST_P(FluxDerivative, FollowsTheChangeOfFrame) {
  for (int i = 0; i < 200; ++i) {
    const Inputs at = draw();
    const Vec3 normal = samples.direction(), s = samples.vector(1);
    Inputs direction{};
    for (int k = 0; k < 3; ++k) direction[1 + k] = direction[6 + k] = s[k];
    direction[10] = dot(s, normal);
    const auto f = flux(at, normal);
    const Conserved<Real> expected{{0, f[0] * s.x, f[0] * s.y, f[0] * s.z, dot(s, momentum(f))}};
    expect_near(derivative(at, direction, normal), expected, 1e-12 * (1 + largest(f)));
  }
}

// With equal states both halves of the Jacobian add up to that of the physical flux (consistency).
TEST_P(FluxDerivative, AddsUpToThePhysicalJacobian) {
  for (int i = 0; i < 200; ++i) {
    Inputs at = draw();
    for (int k = 0; k < 5; ++k) at[5 + k] = at[k];
    const Vec3 normal = samples.direction();
    Inputs direction{};
    for (int k = 0; k < 5; ++k) direction[k] = direction[5 + k] = samples.between(-1, 1);
    Primitive<Dual<1>> w;
    for (int k = 0; k < 5; ++k) {
      w[k].v = at[k];
      w[k].d[0] = direction[k];
    }
    const auto physical = physical_flux(w, normal, Dual<1>(at[10]), gamma_air);
    const auto found = derivative(at, direction, normal);
    for (int row = 0; row < 5; ++row)
      EXPECT_NEAR(found[row], physical[row].d[0], 1e-12 * (1 + std::abs(physical[row].v)));
  }
}

}  // namespace
}  // namespace alphadot
