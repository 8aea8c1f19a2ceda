// A dataset whose rows are spread over the ranks, written by the root piece by piece.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/communicator.hpp"
#include "io/hdf5.hpp"
#include "io/stream_to_root.hpp"

namespace alphadot {

inline constexpr GlobalIndex rows_in_piece = 1 << 18;

/// Makes the dataset `name` of `total` rows from the `rows` of all ranks, in the order of the ranks. A Row is
/// an array of Elements: with `columns` = 0 they are listed one after the other in one dimension, else there
/// are so many columns. Collective; `file` is empty but on the root.
template <class Element, class Row>
void write_rows(const std::optional<hdf5::File>& file, const std::string& name, std::span<const Row> rows,
                GlobalIndex total, GlobalIndex columns, const Communicator& comm) {
  // NOLINTNEXTLINE(bugprone-sizeof-expression): a row may be one element
  constexpr auto in_row = static_cast<GlobalIndex>(sizeof(Row) / sizeof(Element));
  const GlobalIndex rows_of_file = columns == 0 ? in_row : 1;
  std::optional<hdf5::Dataset> target;
  comm.on_root([&] { target.emplace(file->create_dataset<Element>(name, total * rows_of_file, columns)); });
  stream_to_root<Row>(
      comm, rows,
      [&](GlobalIndex first, std::span<const Row> piece) {
        target->write(first * rows_of_file, std::span(reinterpret_cast<const Element*>(piece.data()),
                                                      piece.size() * static_cast<std::size_t>(in_row)));
      },
      rows_in_piece);
}

}  // namespace alphadot
