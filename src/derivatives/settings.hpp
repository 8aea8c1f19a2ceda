// How the linear systems behind the stability derivatives are solved.
#pragma once

#include <string>
#include <vector>

#include "core/types.hpp"
#include "core/words.hpp"

namespace alphadot {

enum class SensitivityMethod { gmres, march };

namespace words {
inline constexpr Word<SensitivityMethod> sensitivity[] = {{"gmres", SensitivityMethod::gmres},
                                                          {"march", SensitivityMethod::march}};
}
template <>
inline constexpr std::span<const Word<SensitivityMethod>> words_of<SensitivityMethod> = words::sensitivity;

/// How the linear systems behind the stability derivatives are solved.
struct DerivativeSettings {
  SensitivityMethod method = SensitivityMethod::gmres;
  Real orders = 3;      ///< decades that the residual must drop
  int directions = 80;  ///< of the Krylov space before it begins anew
  int max_iterations = 300;
  bool second_order = false;         ///< also with respect to the second time derivatives of alpha and beta
  bool control_rates = false;        ///< also with respect to the rates of controls
  bool limiter_uncertainty = false;  ///< solve once more with the limiter's factors held
  std::vector<std::string> coarser_meshes = {};  ///< at most two, the finer first; as mesh.file
};

}  // namespace alphadot
