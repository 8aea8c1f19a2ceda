#include "io/checkpoint.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <bit>
#include <cstring>
#include <optional>

#include "core/error.hpp"
#include "io/files.hpp"
#include "io/seal.hpp"
#include "io/stream_from_root.hpp"
#include "io/vtkhdf_grid.hpp"
#include "io/write_rows.hpp"

namespace alphadot {
namespace {

constexpr const char* format_name = "alphadot checkpoint";
constexpr std::int64_t format_version = 4;

/// Sum over cells of a hash of id and state: the same in any order and on any number of ranks.
class StateSum {
 public:
  void add(GlobalIndex id, const Five<Real>& state) {
    std::array<std::byte, sizeof(id) + sizeof(state)> bytes;
    std::memcpy(bytes.data(), &id, sizeof(id));
    std::memcpy(bytes.data() + sizeof(id), &state, sizeof(state));
    sum_ += XXH64(bytes.data(), bytes.size(), 0);
  }
  /// Over all ranks. Collective.
  std::int64_t total(const Communicator& comm) const {
    std::uint64_t all = sum_;
    MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_UINT64_T, MPI_SUM, comm.handle());
    return std::bit_cast<std::int64_t>(all);
  }
  std::int64_t value() const { return std::bit_cast<std::int64_t>(sum_); }

 private:
  std::uint64_t sum_ = 0;
};

std::int64_t sum_of(const CheckpointField& field, const Subdomain& domain, const Communicator& comm) {
  StateSum sum;
  for (std::size_t i = 0; i < static_cast<std::size_t>(domain.owned_cells); ++i)
    sum.add(domain.cell_ids[i], field.values[i]);
  return sum.total(comm);
}

std::string dataset_of(const CheckpointField& field) {
  return "VTKHDF/CellData/" + field.name;
}

void write_head(const hdf5::File& file, const CheckpointHead& head) {
  auto group = file.create_group("head");
  group.set_attribute("format", format_name);
  group.set_attribute("format_version", format_version);
  group.set_attribute("phase", head.phase);
  group.write_text("message", head.message);
  group.create_group("numbers");
  for (const auto& [name, values] : head.numbers) group.write("numbers/" + name, values);
  auto history = file.create_group("history");
  head.history.write(history);
}

Five<Real> state_at(const std::vector<double>& rows, std::size_t i) {
  Five<Real> out;
  for (int k = 0; k < 5; ++k) out[k] = rows[5 * i + static_cast<std::size_t>(k)];
  return out;
}

/// Reads states piece by piece and compares them with the sum that belongs to them. For one rank.
void verify_states(const hdf5::File& file, const std::string& name, std::int64_t expected) {
  const auto states = file.dataset(name);
  StateSum sum;
  for (GlobalIndex first = 0; first < states.rows(); first += rows_in_piece) {
    const auto piece = states.read<double>(first, std::min(rows_in_piece, states.rows() - first));
    for (std::size_t i = 0; i < piece.size() / 5; ++i)
      sum.add(first + static_cast<GlobalIndex>(i), state_at(piece, i));
  }
  if (sum.value() != expected)
    throw InputError(file.file(), 0, fmt::format("{} read back is not what was written", name),
                     "check the disk");
}

}  // namespace

CheckpointFile::CheckpointFile(const Subdomain& domain, const Communicator& comm)
    : domain_(domain),
      comm_(comm),
      cells_(std::span(domain.cell_ids).first(static_cast<std::size_t>(domain.owned_cells)),
             domain.global_cells, comm),
      points_(std::span(domain.point_ids).first(static_cast<std::size_t>(domain.owned_points)),
              domain.global_points, comm) {}

void CheckpointFile::write(const std::string& path, const CheckpointHead& head,
                           const std::vector<CheckpointField>& fields) const {
  std::optional<Replacement> replacement;
  std::optional<hdf5::File> file;
  comm_.on_root([&] {
    replacement.emplace(path);
    file.emplace(hdf5::File::create(replacement->temporary()));
    create_vtk_group(*file);
    write_head(*file, head);
  });

  using Corners = std::array<GlobalIndex, 4>;
  using Position = std::array<float, 3>;
  std::vector<Corners> corners;
  for (std::size_t i = 0; i < static_cast<std::size_t>(domain_.owned_cells); ++i) {
    auto& cell = corners.emplace_back();
    for (std::size_t k = 0; k < 4; ++k)
      cell[k] = domain_.point_ids[static_cast<std::size_t>(domain_.cell_points[i][k])];
  }
  std::vector<Position> positions;
  for (const auto& point : domain_.points)
    positions.push_back(
        {static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z)});
  write_rows<std::int64_t, Corners>(file, "VTKHDF/Connectivity", cells_.to_slab<Corners>(corners),
                                    cells_.total(), 0, comm_);
  write_rows<float, Position>(file, "VTKHDF/Points", points_.to_slab<Position>(positions), points_.total(), 3,
                              comm_);

  std::vector<std::int64_t> sums;
  for (const auto& field : fields) {
    write_rows<double, Five<Real>>(file, dataset_of(field), cells_.to_slab<Five<Real>>(field.values),
                                   cells_.total(), 5, comm_);
    sums.push_back(sum_of(field, domain_, comm_));
  }

  comm_.on_root([&] {
    write_vtk_sizes(file->group("VTKHDF"), points_.total(), cells_.total(), 4, vtk_tetra);
    for (std::size_t i = 0; i < fields.size(); ++i)
      file->dataset(dataset_of(fields[i])).set_attribute("sum", sums[i]);
    file->close();
    {
      const auto written = hdf5::File::open(replacement->temporary());
      for (std::size_t i = 0; i < fields.size(); ++i) verify_states(written, dataset_of(fields[i]), sums[i]);
    }
    seal_file(replacement->temporary());
    replacement->commit();
  });
}

void CheckpointFile::read_fields(const std::string& path, const std::vector<CheckpointField>& fields) const {
  std::optional<hdf5::File> file;
  comm_.on_root([&] { file.emplace(hdf5::File::open(path)); });
  for (const auto& field : fields) {
    const auto name = dataset_of(field);
    std::optional<hdf5::Dataset> source;
    GlobalIndex expected = 0;
    comm_.on_root([&] {
      source.emplace(file->dataset(name));
      if (source->rows() != cells_.total() || source->columns() != 5)
        throw InputError(path, 0,
                         fmt::format("{} has {} rows of {} numbers, the mesh has {} cells", name,
                                     source->rows(), source->columns(), cells_.total()));
      expected = source->attribute<std::int64_t>("sum");
    });
    std::vector<Five<Real>> slab(static_cast<std::size_t>(cells_.size()));
    stream_from_root<Five<Real>>(
        comm_, slab,
        [&](GlobalIndex first, std::span<Five<Real>> piece) {
          const auto values = source->read<double>(first, static_cast<GlobalIndex>(piece.size()));
          for (std::size_t i = 0; i < piece.size(); ++i) piece[i] = state_at(values, i);
        },
        rows_in_piece);
    cells_.from_slab<Five<Real>>(slab, field.values);
    const auto found = sum_of(field, domain_, comm_);
    comm_.on_root([&] {
      if (found != expected)
        throw InputError(path, 0, name + ": the states that arrived are not those that were written");
    });
  }
}

CheckpointHead read_checkpoint_head(const std::string& path) {
  const auto file = hdf5::File::open(path);
  if (!file.has("head") || file.group("head").text_attribute("format") != format_name)
    throw InputError(path, 0, "is not a checkpoint of alphadot");
  const auto group = file.group("head");
  if (const auto version = group.attribute<std::int64_t>("format_version"); version != format_version)
    throw InputError(
        path, 0, fmt::format("is a checkpoint of format {}, this program reads {}", version, format_version));
  CheckpointHead head;
  head.phase = group.text_attribute("phase");
  head.message = group.dataset("message").read_text();
  const auto numbers = group.group("numbers");
  for (const auto& name : numbers.names()) head.numbers[name] = numbers.dataset(name).read<double>();
  head.history = History::read(file.group("history"));
  return head;
}

CheckpointStates read_checkpoint_states(const std::string& path) {
  const auto file = hdf5::File::open(path);
  const auto states = file.group("VTKHDF/CellData");
  CheckpointStates out{states.names(), 0};
  for (const auto& name : out.names) out.cells = states.dataset(name).rows();
  return out;
}

}  // namespace alphadot
