// TagIndex: dense and sparse tags, absent ones and those used twice.
#include "io/tag_index.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace alphadot {
namespace {

constexpr GlobalIndex smallest = std::numeric_limits<GlobalIndex>::min();
constexpr GlobalIndex largest = std::numeric_limits<GlobalIndex>::max();

void expect_found(const std::vector<GlobalIndex>& tags) {
  const TagIndex index(tags);
  EXPECT_FALSE(index.duplicate());
  for (std::size_t i = 0; i < tags.size(); ++i) EXPECT_EQ(index.find(tags[i]), static_cast<GlobalIndex>(i));
}

TEST(TagIndex, FindsDenseSparseAndExtremeTags) {
  expect_found({});
  expect_found({1, 2, 3});
  expect_found({5, 3, 4, 7});
  expect_found({1'000'000'000'000, 3, 70});
  expect_found({largest, smallest, 0, -1});
  expect_found({largest, largest - 1});
}

TEST(TagIndex, KnowsWhatIsNotThere) {
  for (const GlobalIndex tag : {smallest, GlobalIndex{-1}, GlobalIndex{0}, GlobalIndex{4}, largest}) {
    EXPECT_EQ(TagIndex().find(tag), -1);
    EXPECT_EQ(TagIndex({3, 5, 6}).find(tag), -1);
    EXPECT_EQ(TagIndex({3, 500, 600}).find(tag), -1);
  }
}

TEST(TagIndex, TellsATagUsedTwice) {
  EXPECT_EQ(TagIndex({1, 2, 3, 2}).duplicate(), 2);
  EXPECT_EQ(TagIndex({1, 2000, 3, 2000}).duplicate(), 2000);
}

}  // namespace
}  // namespace alphadot
