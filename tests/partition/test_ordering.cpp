// The dual graph, its cutting by METIS and the downstream order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "partition/decompose.hpp"
#include "partition/dual_graph.hpp"
#include "partition/ordering.hpp"
#include "support/box_mesh.hpp"

namespace alphadot {
namespace {

using testing_support::box_mesh;

Adjacency graph_of(const Mesh& mesh) {
  return dual_graph(mesh.cells, mesh.points.size());
}

std::vector<Vec3> centers_of(const Mesh& mesh) {
  std::vector<Vec3> centers;
  for (const auto& cell : mesh.cells) {
    Vec3& center = centers.emplace_back();
    for (const GlobalIndex point : cell) center += 0.25 * mesh.points[point];
  }
  return centers;
}

void shuffle_cells(Mesh& mesh) {
  std::shuffle(mesh.cells.begin(), mesh.cells.end(), std::mt19937(3));
}

/// The place of every cell in an order.
std::vector<Index> places(const std::vector<Index>& order) {
  std::vector<Index> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<Index>(i);
  return place;
}

// By definition: cells share a face when they share three points.
TEST(DualGraph, JoinsTheCellsThatShareThreePoints) {
  const Mesh mesh = box_mesh({.cells = {2, 2, 1}});
  const Adjacency graph = graph_of(mesh);
  ASSERT_EQ(graph.rows(), 24);
  for (Index a = 0; a < graph.rows(); ++a)
    for (Index b = 0; b < graph.rows(); ++b) {
      const auto& p = mesh.cells[a];
      const auto& q = mesh.cells[b];
      const auto shared = std::count_if(
          p.begin(), p.end(), [&](GlobalIndex id) { return std::find(q.begin(), q.end(), id) != q.end(); });
      EXPECT_EQ(std::count(graph[a].begin(), graph[a].end(), b), shared == 3 ? 1 : 0) << a << " " << b;
    }
}

// The tolerance asked of METIS is 1 % above the mean; a cell or two more come from rounding.
TEST(Decompose, BalancesPartsThatAreInOnePiece) {
  const Mesh mesh = box_mesh({.cells = {12, 10, 8}});
  const Adjacency graph = graph_of(mesh);
  for (const int parts : {2, 3, 4, 7, 16}) {
    const auto owner = decompose(mesh, parts);
    ASSERT_EQ(owner.size(), mesh.cells.size());
    EXPECT_EQ(owner, decompose(mesh, parts)) << "not the same at every call";
    const Real mean = static_cast<Real>(owner.size()) / parts;
    for (int part = 0; part < parts; ++part) {
      const auto size = std::count(owner.begin(), owner.end(), part);
      EXPECT_LE(static_cast<Real>(size), 1.01 * mean + 2) << part << " of " << parts;
      std::vector<Index> reached{
          static_cast<Index>(std::find(owner.begin(), owner.end(), part) - owner.begin())};
      std::vector<char> seen(owner.size(), 0);
      seen[reached[0]] = 1;
      for (std::size_t i = 0; i < reached.size(); ++i)
        for (const Index cell : graph[reached[i]])
          if (owner[cell] == part && !seen[cell]) {
            seen[cell] = 1;
            reached.push_back(cell);
          }
      EXPECT_EQ(static_cast<std::ptrdiff_t>(reached.size()), size) << part << " of " << parts;
    }
  }
}

// A straight cut of a cube of n^3 cubes crosses 2 n^2 faces; METIS should come within twice of it, where a
// random cut crosses half of all, about 6 n^3.
TEST(Decompose, CutsFewFaces) {
  const Mesh mesh = box_mesh({.cells = {10, 10, 10}});
  const Adjacency graph = graph_of(mesh);
  const auto owner = decompose(mesh, 2);
  int cut = 0;
  for (Index cell = 0; cell < graph.rows(); ++cell)
    for (const Index neighbour : graph[cell]) cut += cell < neighbour && owner[cell] != owner[neighbour];
  EXPECT_LE(cut, 2 * 2 * 10 * 10);
}

TEST(Decompose, HandlesAMeshInTwoPieces) {
  Mesh mesh = box_mesh({.cells = {3, 3, 3}});
  const Mesh other = box_mesh({.cells = {3, 3, 3}, .lower = {2, 0, 0}, .upper = {3, 1, 1}});
  const auto shift = static_cast<GlobalIndex>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
  for (auto cell : other.cells) {
    for (GlobalIndex& point : cell) point += shift;
    mesh.cells.push_back(cell);
  }
  const auto owner = decompose(mesh, 3);
  for (int part = 0; part < 3; ++part) EXPECT_GT(std::count(owner.begin(), owner.end(), part), 0);
}

TEST(Decompose, RefusesMorePartsThanCells) {
  const Mesh mesh = box_mesh({.cells = {1, 1, 1}});
  EXPECT_THROW(decompose(mesh, 7), InputError);
  EXPECT_EQ(decompose(mesh, 1), std::vector<int>(6, 0));
}

// Either every part has a cell, or the error says so; nothing else may come of tiny meshes.
TEST(Decompose, LeavesNoPartEmptyUnnoticed) {
  for (const int cubes : {1, 2, 4}) {
    const Mesh mesh = box_mesh({.cells = {cubes, 1, 1}});
    for (int parts = 2; parts <= 6 * cubes; ++parts) {
      try {
        const auto owner = decompose(mesh, parts);
        for (int part = 0; part < parts; ++part) EXPECT_GT(std::count(owner.begin(), owner.end(), part), 0);
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("ranks for"), std::string::npos) << error.what();
      }
    }
  }
}

// The defining property: whatever lies upstream of a cell has been updated before it in a forward sweep.
TEST(Ordering, PutsEveryCellAfterItsUpstreamNeighbours) {
  Mesh mesh = box_mesh({.cells = {8, 4, 4}, .perturbation = 0.1});
  shuffle_cells(mesh);
  const Adjacency graph = graph_of(mesh);
  const auto centers = centers_of(mesh);
  const auto order = downstream_order(graph, centers);

  std::vector<Index> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  std::vector<Index> all(mesh.cells.size());
  std::iota(all.begin(), all.end(), 0);
  ASSERT_EQ(sorted, all) << "not a permutation";

  const auto place = places(order);
  for (Index cell = 0; cell < graph.rows(); ++cell)
    for (const Index neighbour : graph[cell])
      if (centers[neighbour].x < centers[cell].x - 1e-8) {
        EXPECT_LT(place[neighbour], place[cell]);
      }
}

// In a shuffled order of 1920 cells two neighbours are 640 places apart on average. Sorted by x they would be
// within a slice of 96 cells or so of each other; depth first must not do worse.
TEST(Ordering, KeepsNeighboursClose) {
  Mesh mesh = box_mesh({.cells = {20, 4, 4}});
  shuffle_cells(mesh);
  const Adjacency graph = graph_of(mesh);
  const auto place = places(downstream_order(graph, centers_of(mesh)));
  Real distance = 0, pairs = 0;
  for (Index cell = 0; cell < graph.rows(); ++cell)
    for (const Index neighbour : graph[cell]) {
      distance += std::abs(place[cell] - place[neighbour]);
      ++pairs;
    }
  EXPECT_LT(distance / pairs, 96);
}

TEST(Ordering, PassesOverCellsBeyondItsOwnAndReachesEveryPiece) {
  // 0 - 3 - 1   2: cell 3 is a ghost, so that 0, 1 and 2 are three pieces. The most upstream one is 2.
  const Adjacency graph{{0, 1, 2, 2, 4}, {3, 3, 0, 1}};
  const std::vector<Vec3> centers{{2, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
  EXPECT_EQ(downstream_order(graph, centers), (std::vector<Index>{2, 1, 0}));
}

}  // namespace
}  // namespace alphadot
