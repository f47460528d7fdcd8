/// killed_run FOLDER MICROSECONDS: a small run in time that writes everything a run writes, goes on from its checkpoint if there is one,
/// and kills itself (SIGKILL, as kill -9) after this time; 0: never. Prints how long its loop took, in microseconds.
#include <fmt/core.h>
#include <mpi.h>
#include <sys/time.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <optional>

#include "thixis/output/checkpoint.hpp"
#include "thixis/output/fields.hpp"
#include "thixis/output/history.hpp"
#include "thixis/output/series.hpp"
#include "written.hpp"

namespace thixis::output {
namespace {

constexpr int frames = 30, refined_at = 17, checkpoint_every = 2;

Grid grid_of_frame(int n, const core::Comm& comm) { return Strip{n < refined_at ? 2000 : 3000}.grid(comm); }

/// u^n on the points of a grid that this rank owns.
struct State {
  int next = 0;  ///< frame
  CheckpointBlock u{"u", {}, {}};

  explicit State(const core::Comm& comm) { move_to(grid_of_frame(0, comm), comm, nullptr); }
  State(const StoredCheckpoint& stored, const core::Comm& comm) : next(static_cast<int>(stored.attribute("frames"))) {
    move_to(grid_of_frame(next - 1, comm), comm, &stored);
  }

  void move_to(const Grid& grid, const core::Comm& comm, const StoredCheckpoint* stored) {
    u.ids.clear();
    for (std::size_t i = 0; i < grid.points.size(); ++i)
      if (grid.point_owner[i] == comm.rank()) u.ids.push_back(grid.point_id[i]);
    u.values = stored ? stored->fetch("u", u.ids) : std::vector<double>(u.ids.size(), 1.0);
  }
  void step() {
    for (std::size_t i = 0; i < u.ids.size(); ++i) u.values[i] = std::sin(u.values[i] + static_cast<double>(u.ids[i]));
  }
  FieldData field(const Grid& grid, const core::Comm& comm) const {
    std::size_t i = 0;
    return owned_field("u", Centre::vertex, grid, comm, 1, [&](GlobalIndex, int) { return u.values[i++]; });
  }
};

void run(const std::string& folder, const core::Comm& comm) {
  const std::string checkpoint = folder + "/checkpoint.h5";
  std::optional<StoredCheckpoint> stored;
  if (comm.on_root([&] { return std::filesystem::exists(checkpoint); })) stored.emplace(read_checkpoint(checkpoint, comm));
  const auto count = [&](const char* name) { return stored ? static_cast<int>(stored->attribute(name)) : 0; };
  State state = stored ? State(*stored, comm) : State(comm);
  FieldWriter fields = FieldWriter::series(folder, comm, count("frames"));
  History history = History::go_on(folder + "/history.csv", count("history"), comm);
  Series series = Series::go_on(folder + "/series.csv", {"u"}, count("series"), comm);

  for (int n = state.next; n < frames; ++n) {
    const Grid grid = grid_of_frame(n, comm);
    if (n == refined_at) state.move_to(grid, comm, nullptr);
    state.step();
    HistoryRow row;
    row.time_step = n;
    for (int k = 0; k < 20; ++k) {
      row.newton = k;
      row.residual = std::exp(-k - n / 7.0);
      history.append(row);
    }
    series.append(n / 7.0, {comm.max(state.u.values.empty() ? -1.0 : state.u.values.front())});
    fields.write(grid, {state.field(grid, comm)}, n / 7.0);
    if ((n + 1) % checkpoint_every != 0) continue;
    Checkpoint now;
    now.attributes = {{"frames", n + 1}, {"history", history.rows()}, {"series", series.rows()}};
    now.blocks = {state.u};
    write_checkpoint(checkpoint, now, comm);
  }
  fields.close();
}

void kill_in(long microseconds) {
  std::signal(SIGALRM, [](int) { ::kill(::getpid(), SIGKILL); });
  itimerval timer{};
  timer.it_value.tv_sec = microseconds / 1000000;
  timer.it_value.tv_usec = microseconds % 1000000;
  ::setitimer(ITIMER_REAL, &timer, nullptr);
}

}  // namespace
}  // namespace thixis::output

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  if (argc != 3) MPI_Abort(MPI_COMM_WORLD, 2);
  const auto start = std::chrono::steady_clock::now();
  thixis::output::kill_in(std::strtol(argv[2], nullptr, 10));
  const thixis::core::Comm comm;
  try {
    thixis::output::run(argv[1], comm);
  } catch (const std::exception& error) {
    if (comm.root()) fmt::print(stderr, "{}\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  const auto taken = std::chrono::steady_clock::now() - start;
  thixis::output::kill_in(0);
  if (comm.root()) fmt::print("{}\n", std::chrono::duration_cast<std::chrono::microseconds>(taken).count());
  MPI_Finalize();
}
