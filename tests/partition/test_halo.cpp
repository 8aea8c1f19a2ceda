// Exchange of ghost values. Expectations: the owner's value is a known function of the global cell id and the
// round.
#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

#include "parallel.hpp"
#include "partition/reverse_halo.hpp"

namespace alphadot {
namespace {

using testing_support::random_owners;
using testing_support::test_box;

constexpr Real untouched = -1;

Real value_of(GlobalIndex cell, int round) {
  return static_cast<Real>(cell) + 0.5 + 10000 * round;
}

void fill_owned(const Subdomain& domain, std::span<Real> values, int round) {
  for (Index cell = 0; cell < domain.total_cells; ++cell)
    values[cell] = cell < domain.owned_cells ? value_of(domain.cell_ids[cell], round) : untouched;
}

class Halo : public testing::TestWithParam<bool> {
 protected:
  const Communicator comm;
  const Mesh mesh = test_box();
  const Subdomain domain =
      GetParam() ? distribute(mesh, random_owners(mesh, comm.size()), comm) : distribute(mesh, comm);
  const std::size_t cells = static_cast<std::size_t>(domain.total_cells);

  void expect_ghosts(std::span<const Real> values, int round, HaloWidth width) const {
    for (const auto& neighbour : domain.neighbours)
      for (Index i = 0; i < neighbour.ghost_count; ++i) {
        const auto ghost = static_cast<std::size_t>(neighbour.ghost_begin + i);
        const bool filled = width == HaloWidth::points || i < neighbour.ghost_face_count;
        EXPECT_EQ(values[ghost], filled ? value_of(domain.cell_ids[ghost], round) : untouched);
      }
  }
};
INSTANTIATE_TEST_SUITE_P(Partitions, Halo, testing::Bool(),
                         [](const auto& random) { return random.param ? "random" : "metis"; });

TEST_P(Halo, FillsGhostsAgainAndAgain) {
  for (const HaloWidth width : {HaloWidth::points, HaloWidth::faces}) {
    std::vector<Real> values(cells);
    HaloExchange<Real> halo(domain, comm, values, width);
    for (int round = 0; round < 3; ++round) {
      fill_owned(domain, values, round);
      halo.exchange();
      expect_ghosts(values, round, width);
    }
  }
}

TEST_P(Halo, KeepsTwoArraysInFlightApart) {
  std::vector<Real> first(cells), second(cells);
  HaloExchange<Real> first_halo(domain, comm, first), second_halo(domain, comm, second, HaloWidth::faces);
  for (int round = 0; round < 2; ++round) {
    fill_owned(domain, first, round);
    fill_owned(domain, second, round + 5);
    first_halo.start();
    second_halo.start();
    second_halo.wait();
    first_halo.wait();
    expect_ghosts(first, round, HaloWidth::points);
    expect_ghosts(second, round + 5, HaloWidth::faces);
  }
}

TEST_P(Halo, SendsTheValuesAtTheTimeOfStart) {
  std::vector<Real> values(cells);
  HaloExchange<Real> halo(domain, comm, values);
  fill_owned(domain, values, 1);
  halo.start();
  for (Index cell = 0; cell < domain.owned_cells; ++cell) values[cell] = 0;
  halo.wait();
  expect_ghosts(values, 1, HaloWidth::points);
}

TEST_P(Halo, CarriesStructuresAndInterleavedComponents) {
  struct State {
    Real density;
    Vec3 momentum;
  };
  std::vector<State> states(cells);
  std::vector<Real> components(3 * cells);
  for (std::size_t cell = 0; cell < static_cast<std::size_t>(domain.owned_cells); ++cell) {
    const Real value = value_of(domain.cell_ids[cell], 0);
    states[cell] = {value, {-value, 0, 2 * value}};
    for (std::size_t i = 0; i < 3; ++i) components[3 * cell + i] = value * static_cast<Real>(i + 1);
  }
  HaloExchange<State>(domain, comm, states).exchange();
  HaloExchange<Real>(domain, comm, components).exchange();
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const Real value = value_of(domain.cell_ids[cell], 0);
    EXPECT_EQ(states[cell].density, value);
    EXPECT_EQ(states[cell].momentum.z, 2 * value);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(components[3 * cell + i], value * static_cast<Real>(i + 1));
  }
}

TEST_P(Halo, SendsAsManyBytesAsAllGhostsHold) {
  std::vector<Real> values(cells);
  const HaloExchange<Real> points(domain, comm, values), faces(domain, comm, values, HaloWidth::faces);
  GlobalIndex ghosts = 0, face_ghosts = 0;
  for (const auto& neighbour : domain.neighbours) {
    ghosts += neighbour.ghost_count;
    face_ghosts += neighbour.ghost_face_count;
  }
  const auto bytes = [&](const HaloExchange<Real>& halo) {
    return comm.sum(static_cast<GlobalIndex>(halo.bytes_sent()));
  };
  EXPECT_EQ(bytes(points), 8 * comm.sum(ghosts));
  EXPECT_EQ(bytes(faces), 8 * comm.sum(face_ghosts));
}

// Every ghost holds its cell's value; the owner gets one for each rank that holds a ghost of it, in either
// width.
TEST_P(Halo, GivesTheValuesOfGhostsBackToTheirOwners) {
  for (const HaloWidth width : {HaloWidth::points, HaloWidth::faces}) {
    std::vector<Real> values(cells);
    ReverseHaloExchange<Real> reverse(domain, comm, values, width);
    HaloExchange<Real> halo(domain, comm, values, width);
    std::vector<Real> ghosts_of(static_cast<std::size_t>(domain.global_cells), 0);
    for (const auto& neighbour : domain.neighbours)
      for (Index i = 0; i < (width == HaloWidth::points ? neighbour.ghost_count : neighbour.ghost_face_count);
           ++i)
        ++ghosts_of[static_cast<std::size_t>(domain.cell_ids[neighbour.ghost_begin + i])];
    comm.sum(ghosts_of);
    for (int round = 0; round < 2; ++round) {
      fill_owned(domain, values, round);
      halo.exchange();
      reverse.exchange();
      for (Index cell = 0; cell < domain.owned_cells; ++cell)
        EXPECT_EQ(values[cell], (1 + ghosts_of[static_cast<std::size_t>(domain.cell_ids[cell])]) *
                                    value_of(domain.cell_ids[cell], round));
    }
  }
}

TEST_P(Halo, RefusesAnArrayOfAnotherSize) {
  std::vector<Real> values(cells + 1);
  EXPECT_THROW(HaloExchange<Real>(domain, comm, values), std::logic_error);
  EXPECT_THROW(ReverseHaloExchange<Real>(domain, comm, values), std::logic_error);
}

// A leaked or dangling exchange would receive into freed memory: the next ones would be wrong or hang.
TEST_P(Halo, EndsAnExchangeThatWasNotWaitedFor) {
  for (int round = 0; round < 3; ++round) {
    std::vector<Real> values(cells);
    HaloExchange<Real> halo(domain, comm, values);
    fill_owned(domain, values, round);
    halo.start();
  }
  std::vector<Real> values(cells);
  HaloExchange<Real> halo(domain, comm, values);
  fill_owned(domain, values, 7);
  halo.exchange();
  expect_ghosts(values, 7, HaloWidth::points);
}

}  // namespace
}  // namespace alphadot
