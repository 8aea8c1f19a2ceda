#include "solver/block_matrix.hpp"

#include <Eigen/LU>

namespace alphadot {

BlockMatrix::BlockMatrix(const Subdomain& domain)
    : begin_(static_cast<std::size_t>(domain.owned_cells) + 1, 0),
      inverse_diagonal_(static_cast<std::size_t>(domain.owned_cells) + 1),
      slot_(domain.faces.size(), {-1, -1}) {
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    for (const Index face : domain.cell_faces[cell]) {
      const bool is_left = domain.faces[face].left == cell;
      slot_[face][is_left ? 0 : 1] = static_cast<Index>(columns_.size());
      columns_.push_back(is_left ? domain.faces[face].right : domain.faces[face].left);
    }
    begin_[cell + 1] = static_cast<Index>(columns_.size());
  }
  blocks_.resize(columns_.size() + 1);
}

std::size_t BlockMatrix::bytes() const {
  return (begin_.size() + columns_.size() + 2 * slot_.size()) * sizeof(Index) +
         (blocks_.size() + inverse_diagonal_.size()) * sizeof(Block);
}

std::array<Real, 25> inverse(const std::array<Real, 25>& matrix) {
  using Matrix5 = Eigen::Matrix<Real, 5, 5>;
  std::array<Real, 25> out;
  Eigen::Map<Matrix5>(out.data()) =
      Eigen::Map<const Matrix5>(matrix.data()).partialPivLu().solve(Matrix5::Identity());
  return out;
}

}  // namespace alphadot
