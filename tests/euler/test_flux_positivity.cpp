// Strong jumps must leave positive densities and pressures behind.
//
// HLLC with Einfeldt's speeds: the update is a mean over an approximate Riemann solution whose states are all
// positive (Batten, Clarke, Lambert & Causon, SIAM J. Sci. Comput. 18, 1997), while waves travel at most half
// a cell. Van Leer's splitting: F+ and -F- are multiples of positive states (Gressier, Villedieu & Moschetta,
// J. Comput. Phys. 155, 1999). Roe's solver is not positive: with it the solver falls back on smaller
// updates.
#include <gtest/gtest.h>

#include "euler/kinds.hpp"
#include "samples.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

class Positivity : public testing::TestWithParam<FluxKind> {
 protected:
  /// Middle cell after one explicit step in which the fastest wave crosses half a cell.
  Primitive<Real> updated(const Primitive<Real>& a, const Primitive<Real>& b, const Primitive<Real>& c,
                          const Vec3& normal, Real speed) const {
    Real fastest = 0;
    for (const auto& w : {a, b, c})
      fastest = std::max(fastest, std::abs(dot(velocity(w), normal) - speed) + sound_speed(w, gamma_air));
    // Roe's mean of two sides may be faster than both: by its share of their difference of speed.
    const Real step = 0.5 / (1.5 * fastest);
    const auto out = numerical_flux(model, b, c, normal, speed),
               in = numerical_flux(model, a, b, normal, speed);
    return primitive(conserved(b, gamma_air) - step * (out - in), gamma_air);
  }
  const FluxModel model{GetParam(), gamma_air, 0.1};
};
INSTANTIATE_TEST_SUITE_P(Fluxes, Positivity, testing::Values(FluxKind::hllc, FluxKind::van_leer),
                         [](const auto& kind) { return name_of(kind.param); });

TEST_P(Positivity, SurvivesRandomJumpsOfThreeDecades) {
  Samples samples(41);
  for (int i = 0; i < 5000; ++i) {
    const auto a = samples.state(1000, 5), b = samples.state(1000, 5), c = samples.state(1000, 5);
    const auto w = updated(a, b, c, samples.direction(), samples.between(-2, 2));
    EXPECT_GT(w[0], 0);
    EXPECT_GT(w[4], 0);
  }
}

// Einfeldt, Munz, Roe & Sjogreen, J. Comput. Phys. 92, 1991: problem 1-2-0-3, two streams that part.
TEST_P(Positivity, SurvivesStreamsThatPart) {
  const Real pressure = 0.4 * 3;  // (g - 1) times the internal energy 3
  const Primitive<Real> left{{1, -2, 0, 0, pressure}}, right{{1, 2, 0, 0, pressure}};
  for (const auto& w :
       {updated(left, left, right, {1, 0, 0}, 0), updated(left, right, right, {1, 0, 0}, 0)}) {
    EXPECT_GT(w[0], 0);
    EXPECT_GT(w[4], 0);
  }
}

TEST_P(Positivity, SurvivesABlastWave) {
  const Primitive<Real> strong{{1, 0, 0, 0, 1000}}, weak{{1, 0, 0, 0, 0.01}};  // Toro 2009, test 3
  for (const auto& w :
       {updated(strong, strong, weak, {1, 0, 0}, 0), updated(strong, weak, weak, {1, 0, 0}, 0)}) {
    EXPECT_GT(w[0], 0);
    EXPECT_GT(w[4], 0);
  }
}

}  // namespace
}  // namespace alphadot
