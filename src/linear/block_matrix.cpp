#include "linear/block_matrix.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "space/flow_field.hpp"

namespace alphadot {

BlockMatrix::BlockMatrix(const Subdomain& domain)
    : columns_(static_cast<std::size_t>(domain.owned_cells)),
      blocks_(columns_.size() + 1),
      inverse_diagonal_(columns_.size() + 1),
      slots_(domain.faces.size()) {
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    auto& columns = columns_[static_cast<std::size_t>(cell)];
    columns.fill(cell);
    Index used = 0;
    for (const Index face : domain.cell_faces[cell]) {
      const bool is_left = domain.faces[face].left == cell;
      slots_[static_cast<std::size_t>(face)][is_left ? 0 : 1] = {cell, used};
      columns[static_cast<std::size_t>(used++)] =
          is_left ? domain.faces[face].right : domain.faces[face].left;
    }
  }
}

void BlockMatrix::scale_rows() {
  for (std::size_t row = 0; row < columns_.size(); ++row)
    for (Block& block : blocks_[row]) {
      std::array<float, 28> scaled;  // a column's unused lanes are overwritten by the next
      for (std::size_t column = 0; column < 5; ++column)
        multiply_add(0, inverse_diagonal_[row], &block[5 * column])
            .copy_to(&scaled[5 * column], std::experimental::element_aligned);
      std::copy_n(scaled.begin(), 25, block.begin());
    }
}

namespace {

Block transposed(const Block& a) {
  Block out;
  for (std::size_t column = 0; column < 5; ++column)
    for (std::size_t row = 0; row < 5; ++row) out[5 * row + column] = a[5 * column + row];
  return out;
}

}  // namespace

void BlockMatrix::transpose(const Subdomain& domain, const Communicator& comm) {
  for (Block& block : inverse_diagonal_) block = transposed(block);
  transpose_cut_faces(domain, comm);
  for (Index face = 0; face < domain.cut_face_begin; ++face) {
    const Block right = transposed(right_of(face));
    right_of(face) = transposed(left_of(face));
    left_of(face) = right;
  }
}

void BlockMatrix::transpose_cut_faces(const Subdomain& domain, const Communicator& comm) {
  if (comm.size() == 1) return;
  struct Row {
    Blocks blocks;
    std::array<GlobalIndex, neighbours> columns;  // ids
  };
  CellField<Row> rows(domain, comm, HaloWidth::faces);
  for (Index cell = domain.interior_cells; cell < domain.owned_cells; ++cell) {
    rows[cell].blocks = blocks(cell);
    for (std::size_t j = 0; j < neighbours; ++j)
      rows[cell].columns[j] = domain.cell_ids[static_cast<std::size_t>(columns(cell)[j])];
  }
  rows.exchange();
  for (auto face = static_cast<std::size_t>(domain.cut_face_begin); face < domain.faces.size(); ++face) {
    const auto [left, right] = domain.faces[face];
    const Row& other = rows[right];
    const auto slot = std::ranges::find(other.columns, domain.cell_ids[static_cast<std::size_t>(left)]) -
                      other.columns.begin();
    right_of(static_cast<Index>(face)) = transposed(other.blocks[static_cast<std::size_t>(slot)]);
  }
}

std::size_t BlockMatrix::bytes() const {
  return columns_.size() * sizeof(Columns) + slots_.size() * sizeof(slots_[0]) +
         blocks_.size() * sizeof(Blocks) + inverse_diagonal_.size() * sizeof(Block);
}

std::array<Real, 25> inverse(const std::array<Real, 25>& matrix) {
  using Matrix5 = Eigen::Matrix<Real, 5, 5>;
  std::array<Real, 25> out;
  Eigen::Map<Matrix5>(out.data()) =
      Eigen::Map<const Matrix5>(matrix.data()).partialPivLu().solve(Matrix5::Identity());
  return out;
}

}  // namespace alphadot
