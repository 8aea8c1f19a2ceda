// Parts of a configuration, whose loads are looked at by themselves.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "derivatives/case.hpp"
#include "motion/flight_condition.hpp"
#include "space/forces.hpp"

namespace alphadot {

/// The walls of a case by name, each by itself, and the sets of walls that it names.
Components components_of(const Case& settings);

/// What the loads of a half model are without its mirror image: coefficients of the walls of the mesh alone.
FlightCondition of_one_side(FlightCondition settings);

/// Positions of patches among all patches.
std::vector<std::size_t> numbers_of_patches(std::span<const std::string> patches,
                                            std::span<const std::string> patch_names);

/// Some walls, or all of them.
class Part {
 public:
  /// The whole.
  Part() = default;
  /// Walls of these names, which are among those of all patches.
  Part(std::span<const std::string> walls, std::span<const std::string> patch_names);

  /// Of the loads of every patch and their total.
  Load of(std::span<const Load> loads, const Load& total) const;

 private:
  bool is_whole_ = true;
  std::vector<std::size_t> walls_;
};

}  // namespace alphadot
