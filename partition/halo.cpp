#include "partition/halo.hpp"

#include <cstring>

namespace alphadot {

namespace {
constexpr int tag = 2;
}

HaloExchangeBytes::HaloExchangeBytes(const Subdomain& domain, const Communicator& comm, HaloWidth width,
                                     std::byte* values, std::size_t stride)
    : values_(values), stride_(stride) {
  const ByteItem value(stride);
  for (const auto& neighbour : domain.neighbours) {
    const bool points = width == HaloWidth::points;
    const Index ghosts = points ? neighbour.ghost_count : neighbour.ghost_face_count;
    if (ghosts > 0)
      MPI_Recv_init(values + static_cast<std::size_t>(neighbour.ghost_begin) * stride, ghosts, value.type(),
                    neighbour.rank, tag, comm.handle(), &requests_.emplace_back());
    const std::span<const Index> cells =
        points ? std::span(neighbour.send)
               : std::span(neighbour.send).first(static_cast<std::size_t>(neighbour.send_face_count));
    if (!cells.empty()) {
      send_cells_.push_back(cells);
      auto& buffer = send_buffers_.emplace_back(cells.size() * stride);
      MPI_Send_init(buffer.data(), static_cast<int>(cells.size()), value.type(), neighbour.rank, tag,
                    comm.handle(), &requests_.emplace_back());
    }
  }
}

HaloExchangeBytes::~HaloExchangeBytes() {
  wait();  // an exchange that an exception left under way still reads and writes our memory
  for (auto& request : requests_) MPI_Request_free(&request);
}

void HaloExchangeBytes::start() {
  for (std::size_t i = 0; i < send_buffers_.size(); ++i) {
    std::byte* out = send_buffers_[i].data();
    for (const Index cell : send_cells_[i]) {
      std::memcpy(out, values_ + static_cast<std::size_t>(cell) * stride_, stride_);
      out += stride_;
    }
  }
  traffic_.bytes += static_cast<GlobalIndex>(bytes_sent());
  traffic_.messages += static_cast<GlobalIndex>(send_buffers_.size());
  if (!requests_.empty()) MPI_Startall(static_cast<int>(requests_.size()), requests_.data());
}

void HaloExchangeBytes::wait() {
  if (requests_.empty()) return;
  const Real begin = MPI_Wtime();
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  traffic_.wait_seconds += MPI_Wtime() - begin;
}

std::size_t HaloExchangeBytes::bytes_sent() const {
  std::size_t bytes = 0;
  for (const auto& buffer : send_buffers_) bytes += buffer.size();
  return bytes;
}

}  // namespace alphadot
