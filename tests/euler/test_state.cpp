// States and the physical flux. Expectations: definitions of a perfect gas.
#include <gtest/gtest.h>

#include "samples.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

TEST(State, ConvertsThereAndBack) {
  Samples samples(11);
  for (int i = 0; i < 100; ++i) {
    const auto w = samples.state();
    const auto u = conserved(w, gamma_air);
    expect_near(primitive(u, gamma_air), w, 1e-13 * largest(u));
  }
}

// rho E = p / (g - 1) + rho u^2 / 2: 2.8 / 0.4 + 2 (1 + 4 + 9) / 2 = 21. a^2 = g p / rho = 1.96.
TEST(State, HasTheEnergyAndSoundSpeedOfAPerfectGas) {
  const Primitive<Real> w{{2, 1, -2, 3, 2.8}};
  expect_near(conserved(w, gamma_air), {{2, 2, -4, 6, 21}}, 1e-14);
  EXPECT_NEAR(sound_speed(w, gamma_air), 1.4, 1e-15);
}

TEST(State, ScalesTheFreeStreamByDensityAndSoundSpeed) {
  const auto w = free_stream(Vec3{0.3, -0.4, 1.2}, gamma_air);
  EXPECT_EQ(w[0], 1);
  EXPECT_NEAR(sound_speed(w, gamma_air), 1, 1e-15);
  EXPECT_EQ(velocity(w).z, 1.2);
}

// U (u.n - vg) + p (0, n, u.n) with u.n = 2: by hand for the state above, through a face that moves at 0.5.
TEST(PhysicalFlux, IsThatOfTheTextbook) {
  const Primitive<Real> w{{2, 1, -2, 3, 2.8}};
  const Vec3 normal{2.0 / 3, 1.0 / 3, 2.0 / 3};  // u.n = 2
  const auto flux = physical_flux(w, normal, 0.5, gamma_air);
  expect_near(flux, {{3, 3 + 2.8 * 2 / 3, -6 + 2.8 / 3, 9 + 2.8 * 2 / 3, 21 * 1.5 + 2.8 * 2}}, 1e-14);
}

}  // namespace
}  // namespace alphadot
