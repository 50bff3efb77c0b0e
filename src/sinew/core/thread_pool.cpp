#include "sinew/core/thread_pool.hpp"

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/spin_wait.hpp"

namespace sinew {

namespace {

/// Pauses before a waiting thread yields its core: about 20 us on a recent core.
constexpr int kPauses = 1000;
/// Yields before it sleeps: about 0.2 ms on an idle core. That is longer than the gap between two
/// parallel sections of a step (a backward solve), and too short for a user to notice. On a busy
/// core, the first yield lets another thread run.
constexpr int kYields = 600;

/// A counter on its own cache line.
struct alignas(64) Ticket {
  std::atomic<std::uint32_t> value{0};
};

/// The count of parts of a thread, on its own cache line.
struct alignas(64) PartCount {
  std::atomic<long> value{0};
};

/// Waits until `ticket` differs from `old` and returns the new value.
std::uint32_t wait_for_change(const Ticket& ticket, std::uint32_t old, int pauses) {
  SpinWait spin(pauses);
  std::uint32_t now = ticket.value.load(std::memory_order_acquire);
  while (now == old) {
    if (spin.rounds() < pauses + kYields) {
      spin.once();
    } else {
      ticket.value.wait(old, std::memory_order_acquire);
    }
    now = ticket.value.load(std::memory_order_acquire);
  }
  return now;
}

}  // namespace

/// The caller increments `call` to start a round; worker i sets `done[i]` when it has finished.
/// `work`, `context` and `stop` are written before `call` is incremented and read afterwards.
struct ThreadPool::Shared {
  explicit Shared(int count)
      : done(static_cast<std::size_t>(count)),
        parts(static_cast<std::size_t>(count)),
        threads(count) {}

  Ticket call;  // on a cache line of its own
  std::vector<Ticket> done;
  std::vector<PartCount> parts;
  std::vector<std::thread> workers;
  RawWork work = nullptr;
  void* context = nullptr;
  int threads;
  int pauses = 0;
  bool stop = false;

  void serve(int thread) {
    Ticket& mine = done[static_cast<std::size_t>(thread)];
    std::uint32_t seen = 0;
    while (true) {
      seen = wait_for_change(call, seen, pauses);
      if (stop) return;
      work(context, thread);
      mine.value.store(seen, std::memory_order_release);
      mine.value.notify_one();
    }
  }

  std::uint32_t raise() {
    const std::uint32_t round = call.value.load(std::memory_order_relaxed) + 1;
    call.value.store(round, std::memory_order_release);
    call.value.notify_all();
    return round;
  }

  void finish() {
    stop = true;
    raise();
    for (std::thread& worker : workers) worker.join();
  }
};

ThreadPool::ThreadPool(int threads) {
  if (threads < 1) {
    throw Error(ErrorKind::out_of_range, Location{.file = {}, .item = "threads"},
                "the number of threads is " + std::to_string(threads),
                "give at least 1 (the caller itself)");
  }
  shared_ = std::make_unique<Shared>(threads);
  const auto cores = static_cast<int>(std::thread::hardware_concurrency());
  shared_->pauses = threads <= cores ? kPauses : 0;
  shared_->workers.reserve(static_cast<std::size_t>(threads));
  try {
    for (int thread = 1; thread < threads; ++thread) {
      shared_->workers.emplace_back([shared = shared_.get(), thread] { shared->serve(thread); });
    }
  } catch (...) {
    shared_->finish();
    throw;
  }
}

ThreadPool::~ThreadPool() { shared_->finish(); }

int ThreadPool::size() const { return shared_->threads; }

long ThreadPool::parts_done(int thread) const {
  return shared_->parts[static_cast<std::size_t>(thread)].value.load(std::memory_order_relaxed);
}

void ThreadPool::add_parts(int thread, long count) {
  auto& parts = shared_->parts[static_cast<std::size_t>(thread)].value;
  parts.store(parts.load(std::memory_order_relaxed) + count, std::memory_order_relaxed);
}

void ThreadPool::run_raw(RawWork work, void* context) {
  Shared& shared = *shared_;
  if (shared.threads == 1) {
    work(context, 0);
    return;
  }
  shared.work = work;
  shared.context = context;
  const std::uint32_t round = shared.raise();
  work(context, 0);
  for (int thread = 1; thread < shared.threads; ++thread) {
    wait_for_change(shared.done[static_cast<std::size_t>(thread)], round - 1, shared.pauses);
  }
}

}  // namespace sinew
