#include <mpi.h>

#include <ptscotch.h>

#include <cstdio>

#include "core/error.hpp"
#include "partition/partitioners.hpp"

namespace alphadot {

static_assert(sizeof(SCOTCH_Num) == sizeof(GlobalIndex), "PT-Scotch is built with another index width");

namespace {

/// An object of PT-Scotch that ends with its scope. The library returns 0 for success.
template <class T>
class Scoped {
 public:
  Scoped(void (*exit_function)(T*)) : exit_(exit_function) {}
  ~Scoped() {
    if (alive_) exit_(&object_);
  }
  Scoped(const Scoped&) = delete;
  Scoped& operator=(const Scoped&) = delete;

  /// Takes the result of the call that initialises the object.
  bool alive(int failure) { return alive_ = failure == 0; }
  T* get() { return &object_; }

 private:
  T object_{};
  void (*exit_)(T*);
  bool alive_ = false;
};

}  // namespace

std::vector<int> ptscotch_k_way(DistributedGraph& graph, int parts, const Communicator& comm) {
  constexpr double imbalance = 0.01;
  const auto vertices = static_cast<SCOTCH_Num>(graph.begin.size()) - 1;
  const auto edges = static_cast<SCOTCH_Num>(graph.items.size());
  std::vector<SCOTCH_Num> part(static_cast<std::size_t>(vertices) + 1);

  // One thread a rank: with more, version 7.0.3 hangs now and then when MPI gives no full support of threads.
  // Bound to the context: graphs end in the reverse order.
  Scoped<SCOTCH_Strat> strategy(SCOTCH_stratExit);
  Scoped<SCOTCH_Context> context(SCOTCH_contextExit);
  Scoped<SCOTCH_Dgraph> whole(SCOTCH_dgraphExit), bound(SCOTCH_dgraphExit);
  const bool ready =
      strategy.alive(SCOTCH_stratInit(strategy.get())) &&
      SCOTCH_stratDgraphMapBuild(strategy.get(), SCOTCH_STRATQUALITY, comm.size(), parts, imbalance) == 0 &&
      context.alive(SCOTCH_contextInit(context.get())) &&
      SCOTCH_contextOptionSetNum(context.get(), SCOTCH_OPTIONNUMDETERMINISTIC, 1) == 0 &&
      SCOTCH_contextThreadSpawn(context.get(), 1, nullptr) == 0;
  // Every call below is collective: all ranks make it or none.
  const auto all = [&](bool succeeded) { return !comm.any(!succeeded); };
  const bool succeeded =
      all(ready) && all(whole.alive(SCOTCH_dgraphInit(whole.get(), comm.handle()))) &&
      all(SCOTCH_dgraphBuild(whole.get(), 0, vertices, vertices, graph.begin.data(), graph.begin.data() + 1,
                             nullptr, nullptr, edges, edges, graph.items.data(), nullptr, nullptr) == 0) &&
      all(SCOTCH_dgraphInit(bound.get(), comm.handle()) == 0) &&
      all(bound.alive(SCOTCH_contextBindDgraph(context.get(), whole.get(), bound.get()))) &&
      all(SCOTCH_dgraphPart(bound.get(), parts, strategy.get(), part.data()) == 0);
  if (!succeeded) throw InputError("", 0, "PT-Scotch failed", "its own message stands above");
  return {part.begin(), part.end() - 1};
}

}  // namespace alphadot
