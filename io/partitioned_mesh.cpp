#include "io/partitioned_mesh.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "core/error.hpp"
#include "io/files.hpp"
#include "io/foreign_files.hpp"
#include "io/write_rows.hpp"
#include "partition/slabs.hpp"

namespace alphadot {
namespace {

constexpr const char* format_name = "alphadot partitioned mesh";
constexpr std::int64_t format_version = 1;
constexpr const char* damaged_remedy = "make it anew with alphadot partition";

/// Names of the arrays in the order in which their sums make the hash.
constexpr std::array arrays{"cells", "points", "triangles", "triangle_cell", "triangle_patch"};

/// Over the rows of all ranks: a sum of hashes of row and number, the same on any number of ranks.
template <class Row>
std::int64_t sum_over_rows(std::span<const Row> rows, GlobalIndex first, const Communicator& comm) {
  std::uint64_t sum = 0;
  for (const Row& row : rows) sum += XXH64(&row, sizeof(row), static_cast<XXH64_hash_t>(first++));
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, comm.handle());
  return std::bit_cast<std::int64_t>(sum);
}

/// Makes the array `name` with its sum.
template <class Element, class Row>
std::int64_t write_array(std::optional<hdf5::File>& file, const std::string& name, std::span<const Row> rows,
                         const Communicator& comm) {
  // NOLINTNEXTLINE(bugprone-sizeof-expression): a row may be one element
  constexpr auto columns = static_cast<GlobalIndex>(sizeof(Row) / sizeof(Element));
  const auto count = static_cast<GlobalIndex>(rows.size());
  GlobalIndex first = 0;
  MPI_Exscan(&count, &first, 1, MPI_INT64_T, MPI_SUM, comm.handle());
  write_rows<Element, Row>(file, name, rows, comm.sum(count), columns, comm);
  const auto sum = sum_over_rows(rows, first, comm);
  comm.on_root([&] { file->dataset(name).set_attribute("sum", sum); });
  return sum;
}

std::string hash_of(std::span<const std::int64_t> sums, const std::vector<std::string>& patch_names) {
  std::string text;
  for (const auto sum : sums) text += fmt::format("{:016x} ", std::bit_cast<std::uint64_t>(sum));
  for (const auto& name : patch_names) text += name + '\n';
  return fmt::format("{:016x}", XXH64(text.data(), text.size(), 0));
}

[[noreturn]] void fail_damaged(const std::string& path, const std::string& what) {
  throw InputError(path, 0, what, damaged_remedy);
}

/// First cells of the ranks, and at the end their number.
std::vector<GlobalIndex> cell_begins(const PartitionedMeshHeader& header, int ranks) {
  std::vector<GlobalIndex> out;
  const int pieces = header.pieces();
  for (int rank = 0; rank <= ranks; ++rank)
    out.push_back(pieces % ranks == 0 ? header.piece_begin[static_cast<std::size_t>(rank * (pieces / ranks))]
                                      : static_cast<GlobalIndex>(static_cast<double>(rank) / ranks *
                                                                 static_cast<double>(header.cells)));
  return out;
}

/// One rank's part of the arrays on disk.
class Reader {
 public:
  Reader(const std::string& path, const Communicator& comm)
      : path_(path), comm_(comm), file_(hdf5::File::open(path)) {}

  template <class Element, class Row>
  std::vector<Row> rows(const std::string& name, GlobalIndex first, GlobalIndex count) const {
    const auto source = file_.dataset(name);
    std::vector<Row> out(static_cast<std::size_t>(count));
    for (GlobalIndex done = 0; done < count; done += rows_in_piece) {
      const auto piece = source.read<Element>(first + done, std::min(rows_in_piece, count - done));
      std::memcpy(static_cast<void*>(out.data() + done), piece.data(), piece.size() * sizeof(Element));
    }
    return out;
  }

  /// Compares rows of all ranks with the sum that was written with them. Collective.
  template <class Row>
  void verify(const std::string& name, std::span<const Row> rows, GlobalIndex first) const {
    const auto sum = sum_over_rows(rows, first, comm_);
    comm_.on_all([&] {
      if (sum != file_.dataset(name).template attribute<std::int64_t>("sum"))
        fail_damaged(path_, "the array " + name + " is not what was written");
    });
  }

 private:
  const std::string& path_;
  const Communicator& comm_;
  hdf5::File file_;
};

/// Opens an HDF5 file; where that fails and its name is one of another program's, says so.
hdf5::File open_or_name(const std::string& path) {
  try {
    return hdf5::File::open(path);
  } catch (const InputError&) {
    if (const auto problem = foreign_name(path, in_lower_case(path))) throw InputError(std::vector{*problem});
    throw;
  }
}

}  // namespace

bool is_hdf5(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::array<char, 8> beginning{};
  in.read(beginning.data(), beginning.size());
  return in && std::memcmp(beginning.data(), "\x89HDF\r\n\x1a\n", beginning.size()) == 0;
}

bool is_partitioned_mesh(const std::string& path) {
  if (!is_hdf5(path)) return false;
  const auto file = open_or_name(path);
  return file.has_attribute("format") && file.text_attribute("format") == format_name;
}

PartitionedMeshHeader read_partitioned_mesh_header(const std::string& path) {
  if (!is_partitioned_mesh(path)) {
    if (const auto problem = foreign_name(path, in_lower_case(path))) throw InputError(std::vector{*problem});
    throw InputError(path, 0, "is an HDF5 file, but not a mesh prepared by alphadot partition",
                     "name a mesh file in [mesh] file");
  }
  const auto file = hdf5::File::open(path);
  if (const auto version = file.attribute<std::int64_t>("format_version"); version != format_version)
    throw InputError(path, 0, fmt::format("has format {}, this program reads {}", version, format_version),
                     damaged_remedy);
  PartitionedMeshHeader out;
  std::vector<std::int64_t> sums;
  for (const std::string name : arrays) {
    const auto array = file.dataset(name);
    const GlobalIndex columns = name == "cells" ? 4 : name == "points" || name == "triangles" ? 3 : 1;
    if (array.columns() != columns) fail_damaged(path, "the array " + name + " has another shape");
    sums.push_back(array.attribute<std::int64_t>("sum"));
  }
  out.cells = file.dataset("cells").rows();
  out.points = file.dataset("points").rows();
  out.triangles = file.dataset("triangles").rows();
  if (file.dataset("triangle_cell").rows() != out.triangles ||
      file.dataset("triangle_patch").rows() != out.triangles)
    fail_damaged(path, "the arrays of triangles differ in length");
  out.piece_begin = file.dataset("piece_begin").read<std::int64_t>();
  if (out.piece_begin.size() < 2 || out.piece_begin.front() != 0 || out.piece_begin.back() != out.cells ||
      std::adjacent_find(out.piece_begin.begin(), out.piece_begin.end(), std::greater_equal<>()) !=
          out.piece_begin.end())
    fail_damaged(path, "its pieces do not cover its cells");
  const auto patches = file.group("patches");
  for (const auto& name : patches.names()) out.patch_names.push_back(patches.dataset(name).read_text());
  out.hash = hash_of(sums, out.patch_names);
  return out;
}

std::string write_partitioned_mesh(const std::string& path, const OrderedMesh& mesh,
                                   const Communicator& comm) {
  std::optional<Replacement> replacement;
  std::optional<hdf5::File> file;
  comm.on_root([&] {
    replacement.emplace(path);
    file.emplace(hdf5::File::create(replacement->temporary()));
    file->set_attribute("format", format_name);
    file->set_attribute("format_version", format_version);
    file->write("piece_begin", mesh.piece_begin);
    const auto patches = file->create_group("patches");
    for (std::size_t i = 0; i < mesh.part.patch_names.size(); ++i)
      patches.write_text(fmt::format("{:04}", i), mesh.part.patch_names[i]);
  });
  using Row3 = std::array<GlobalIndex, 3>;
  using Row4 = std::array<GlobalIndex, 4>;
  std::vector<Row3> triangles;
  std::vector<std::int32_t> patches;
  for (const auto& triangle : mesh.part.triangles) {
    triangles.push_back(triangle.points);
    patches.push_back(static_cast<std::int32_t>(triangle.patch));
  }
  const std::array sums{
      write_array<std::int64_t, Row4>(file, "cells", mesh.part.cells, comm),
      write_array<double, Vec3>(file, "points", mesh.part.points, comm),
      write_array<std::int64_t, Row3>(file, "triangles", triangles, comm),
      write_array<std::int64_t, GlobalIndex>(file, "triangle_cell", mesh.triangle_cell, comm),
      write_array<std::int32_t, std::int32_t>(file, "triangle_patch", patches, comm)};
  comm.on_root([&] {
    file->close();
    replacement->commit();
  });
  return hash_of(sums, mesh.part.patch_names);
}

MeshPart read_partitioned_mesh(const std::string& path, const Communicator& comm) {
  PartitionedMeshHeader header;
  std::optional<Reader> reader;
  comm.on_all([&] {
    header = read_partitioned_mesh_header(path);
    if (comm.size() > header.cells)
      throw InputError(path, 0, fmt::format("{} ranks for {} cells", comm.size(), header.cells),
                       "use at most one rank a cell");
    reader.emplace(path, comm);
  });
  const auto begins = cell_begins(header, comm.size());
  const auto rank = static_cast<std::size_t>(comm.rank());
  const EqualSlabs point_slabs(header.points, comm.size()), triangle_slabs(header.triangles, comm.size());
  const GlobalIndex first_triangle = triangle_slabs.begin(comm.rank()),
                    triangles = triangle_slabs.size(comm.rank());

  MeshPart part;
  part.file = path;
  part.global_cells = header.cells;
  part.global_points = header.points;
  part.global_triangles = header.triangles;
  part.patch_names = header.patch_names;
  std::vector<std::array<GlobalIndex, 3>> corners;
  std::vector<GlobalIndex> cell;
  std::vector<std::int32_t> patch;
  comm.on_all([&] {
    part.cells = reader->rows<std::int64_t, std::array<GlobalIndex, 4>>("cells", begins[rank],
                                                                        begins[rank + 1] - begins[rank]);
    part.points =
        reader->rows<double, Vec3>("points", point_slabs.begin(comm.rank()), point_slabs.size(comm.rank()));
    corners = reader->rows<std::int64_t, std::array<GlobalIndex, 3>>("triangles", first_triangle, triangles);
    cell = reader->rows<std::int64_t, GlobalIndex>("triangle_cell", first_triangle, triangles);
    patch = reader->rows<std::int32_t, std::int32_t>("triangle_patch", first_triangle, triangles);
  });
  reader->verify<std::array<GlobalIndex, 4>>("cells", part.cells, begins[rank]);
  reader->verify<Vec3>("points", part.points, point_slabs.begin(comm.rank()));
  reader->verify<std::array<GlobalIndex, 3>>("triangles", corners, first_triangle);
  reader->verify<GlobalIndex>("triangle_cell", cell, first_triangle);
  reader->verify<std::int32_t>("triangle_patch", patch, first_triangle);

  part.cell_ids.resize(part.cells.size());
  std::iota(part.cell_ids.begin(), part.cell_ids.end(), begins[rank]);
  std::vector<BoundaryTriangle> read;
  std::vector<int> counts(static_cast<std::size_t>(comm.size()), 0);
  comm.on_all([&] {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (cell[i] < 0 || cell[i] >= header.cells || (i > 0 && cell[i] < cell[i - 1]) || patch[i] < 0 ||
          patch[i] >= static_cast<std::int32_t>(header.patch_names.size()))
        fail_damaged(path, fmt::format("triangle {} is on no cell or patch",
                                       first_triangle + static_cast<GlobalIndex>(i) + 1));
      read.push_back({corners[i], first_triangle + static_cast<GlobalIndex>(i), patch[i]});
      const auto after = std::upper_bound(begins.begin(), begins.end(), cell[i]);
      ++counts[static_cast<std::size_t>(after - begins.begin() - 1)];
    }
  });
  part.triangles = deliver<BoundaryTriangle>(read, counts, comm).items;
  return part;
}

}  // namespace alphadot
