// Projections onto fields. Expectation: the same least squares by a dense decomposition of all equations.
#include "derivatives/reduced_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <random>

namespace alphadot {
namespace {

constexpr int cells = 7, numbers = 5 * cells;

Eigen::VectorXd vector_of(const std::vector<Primitive<Real>>& field) {
  return Eigen::Map<const Eigen::VectorXd>(&field[0][0], 5 * static_cast<Eigen::Index>(field.size()));
}

class ReducedModelTest : public testing::Test {
 protected:
  std::vector<Primitive<Real>> random_field(std::size_t size) {
    std::vector<Primitive<Real>> out(size);
    for (auto& w : out)
      for (int i = 0; i < 5; ++i) w[i] = normal(engine);
    return out;
  }
  std::mt19937 engine{1};
  std::normal_distribution<Real> normal;
};

TEST_F(ReducedModelTest, ProjectsAsDenseLeastSquaresDo) {
  constexpr Real omega = 0.7, weight = 3;
  std::vector<Real> times;
  for (int cell = 0; cell < cells; ++cell) times.push_back(0.5 + 0.1 * cell);
  Eigen::VectorXd mass(numbers);
  for (int i = 0; i < numbers; ++i) mass[i] = times[static_cast<std::size_t>(i / 5)];
  ReducedModel model(times, [](auto&) {});
  const auto first_source = random_field(2 * cells), second_source = random_field(2 * cells);
  model.add_source({first_source, {0.1, 0.2}});
  std::vector<std::vector<Primitive<Real>>> fields, images;
  std::vector<Real> functionals;
  for (int j = 0; j < 4; ++j) {
    fields.push_back(random_field(cells));
    images.push_back(random_field(cells));
    functionals.push_back(normal(engine));
    model.add_field(fields.back(), images.back(), {functionals.back()});
  }
  model.add_field(fields[1], images[1], {functionals[1]});  // nothing new
  model.add_source({second_source, {0.1, 0.2}});
  ASSERT_EQ(model.size(), 4U);

  for (std::size_t source = 0; source < 2; ++source) {
    const auto projections = model.project(source, omega, weight);
    ASSERT_EQ(projections.size(), 4U);
    const Eigen::VectorXd b = vector_of(source == 0 ? first_source : second_source);
    for (Eigen::Index m = 1; m <= 4; ++m) {
      Eigen::MatrixXd all(2 * numbers, 2 * m);
      for (Eigen::Index j = 0; j < m; ++j) {
        const Eigen::VectorXd image = vector_of(images[static_cast<std::size_t>(j)]),
                              moved =
                                  omega * mass.cwiseProduct(vector_of(fields[static_cast<std::size_t>(j)]));
        all.col(j) << image, weight * moved;
        all.col(m + j) << -moved, weight * image;
      }
      Eigen::VectorXd right(2 * numbers);
      right << -b.head(numbers), -weight * b.tail(numbers);
      const Eigen::VectorXd shares = all.colPivHouseholderQr().solve(right);
      const auto& found = projections[static_cast<std::size_t>(m - 1)];
      EXPECT_NEAR(found.norm, (all * shares - right).norm(), 1e-5);
      Real real = 0.1, imaginary = 0.2;
      for (Eigen::Index j = 0; j < m; ++j) {
        real += shares[j] * functionals[static_cast<std::size_t>(j)];
        imaginary += shares[m + j] * functionals[static_cast<std::size_t>(j)];
      }
      EXPECT_NEAR(found.functionals[0], real, 1e-5);
      EXPECT_NEAR(found.functionals[1], imaginary, 1e-5);
      if (m < 4) continue;
      const Eigen::VectorXd combined = vector_of(model.field(found));
      for (Eigen::Index j = 0; j < m; ++j) {
        const Eigen::VectorXd field = vector_of(fields[static_cast<std::size_t>(j)]);
        Real own = 0, turned = 0;
        for (Eigen::Index i = 0; i < m; ++i) {
          const Eigen::VectorXd other = vector_of(fields[static_cast<std::size_t>(i)]);
          own += shares[i] * other.dot(field);
          turned += shares[m + i] * other.dot(field);
        }
        EXPECT_NEAR(combined.head(numbers).dot(field), own, 1e-4);
        EXPECT_NEAR(combined.tail(numbers).dot(field), turned, 1e-4);
      }
    }
  }
}

}  // namespace
}  // namespace alphadot
