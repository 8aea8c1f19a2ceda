#include "partition/reverse_halo.hpp"

namespace alphadot {

namespace {
constexpr int tag = 3;
}

ReverseHaloExchangeBytes::ReverseHaloExchangeBytes(const Subdomain& domain, const Communicator& comm,
                                                   HaloWidth width, const std::byte* values,
                                                   std::size_t stride) {
  const ByteItem value(stride);
  for (const auto& neighbour : domain.neighbours) {
    const bool points = width == HaloWidth::points;
    const std::span all(neighbour.send);
    const auto cells = points ? all : all.first(static_cast<std::size_t>(neighbour.send_face_count));
    if (!cells.empty()) {
      auto& buffer = parts_.emplace_back(Part{cells, std::vector<std::byte>(cells.size() * stride)}).buffer;
      MPI_Recv_init(buffer.data(), static_cast<int>(cells.size()), value.type(), neighbour.rank, tag,
                    comm.handle(), &requests_.emplace_back());
    }
    if (const Index ghosts = points ? neighbour.ghost_count : neighbour.ghost_face_count; ghosts > 0) {
      const auto bytes = static_cast<std::size_t>(ghosts) * stride;
      MPI_Send_init(values + static_cast<std::size_t>(neighbour.ghost_begin) * stride, ghosts, value.type(),
                    neighbour.rank, tag, comm.handle(), &requests_.emplace_back());
      sent_ += static_cast<GlobalIndex>(bytes);
      ++messages_;
    }
  }
}

ReverseHaloExchangeBytes::~ReverseHaloExchangeBytes() {
  receive();  // an exchange that an exception left under way still reads and writes our memory
  for (auto& request : requests_) MPI_Request_free(&request);
}

void ReverseHaloExchangeBytes::start() {
  traffic_.bytes += sent_;
  traffic_.messages += messages_;
  if (!requests_.empty()) MPI_Startall(static_cast<int>(requests_.size()), requests_.data());
}

void ReverseHaloExchangeBytes::receive() {
  if (requests_.empty()) return;
  const Real begin = MPI_Wtime();
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  traffic_.wait_seconds += MPI_Wtime() - begin;
}

std::size_t ReverseHaloExchangeBytes::bytes() const {
  std::size_t bytes = 0;
  for (const auto& part : parts_) bytes += part.buffer.size();
  return bytes;
}

}  // namespace alphadot
