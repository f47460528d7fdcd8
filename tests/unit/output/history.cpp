#include "thixis/output/history.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scratch.hpp"

namespace thixis::output {
namespace {

const std::string header =
    "level,time_step,time,newton,linear,active,changed,residual,eta_disc,eta_lin,eta_alg,eta_total,eta_time,promise,energy_error,seconds\n";

HistoryRow full_row() {
  HistoryRow row;
  row.level = 1;
  row.time_step = 2;
  row.time = 0.1;
  row.newton = 3;
  row.linear = 4;
  row.active = 5000000000ll;
  row.changed = 6;
  row.residual = 1e-300;
  row.eta_disc = 1.0 / 3;
  row.eta_lin = 2;
  row.eta_alg = INFINITY;
  row.eta_total = NAN;
  row.eta_time = 0.25;
  row.promise = "indicator";
  row.energy_error = -0.0;
  row.seconds = 12345678.9;
  return row;
}

}  // namespace

TEST(history, has_a_line_per_row_as_soon_as_it_is_appended) {
  const core::Comm comm;
  const std::string path = scratch("history") + "/history.csv";
  History history(path, comm);
  EXPECT_EQ(content(path), header);
  comm.barrier();
  history.append({});
  EXPECT_EQ(content(path), header + ",,,,,,,,,,,,,,,\n");
  comm.barrier();
  history.append(full_row());
  EXPECT_EQ(content(path),
            header + ",,,,,,,,,,,,,,,\n1,2,0.1,3,4,5000000000,6,1e-300,0.3333333333333333,2,inf,nan,0.25,indicator,-0,12345678.9\n");
}

TEST(history, gives_back_every_double_exactly) {
  const core::Comm comm;
  const std::string path = scratch("history_doubles") + "/history.csv";
  History history(path, comm);
  double value = 0.1;
  for (int i = 0; i < 50; ++i, value *= -3.7e5 / 7 * 1e-7 * (i % 7 + 1)) {
    HistoryRow row;
    row.residual = value;
    history.append(row);
    const std::string text = content(path);
    const std::string line = text.substr(text.rfind('\n', text.size() - 2) + 1);
    EXPECT_EQ(std::stod(line.substr(7)), value) << line;
    comm.barrier();
  }
}

TEST(history, writes_the_row_of_the_root_only) {
  const core::Comm comm;
  const std::string path = scratch("history_root") + "/history.csv";
  HistoryRow row;
  row.level = comm.rank();
  History(path, comm).append(row);
  EXPECT_EQ(content(path), header + "0,,,,,,,,,,,,,,,\n");
}

TEST(history, goes_on_behind_the_rows_that_are_to_stay) {
  const core::Comm comm;
  const std::string path = scratch("history_goes_on") + "/history.csv";
  const auto numbered = [](int k) {
    HistoryRow row;
    row.newton = k;
    return row;
  };
  const auto line = [](int k) { return ",,," + std::to_string(k) + ",,,,,,,,,,,,\n"; };
  {
    History history(path, comm);
    EXPECT_EQ(history.rows(), 0);
    for (int k = 1; k <= 4; ++k) history.append(numbered(k));
    EXPECT_EQ(history.rows(), 4);
  }
  {
    History history = History::go_on(path, 2, comm);
    EXPECT_EQ(history.rows(), 2);
    history.append(numbered(7));
    EXPECT_EQ(content(path), header + line(1) + line(2) + line(7));
    comm.barrier();
  }
  comm.on_root([&] { std::ofstream(path, std::ios::app) << ",,,8,,,"; });  // cut off when the run was killed
  EXPECT_EQ(History::go_on(path, 10, comm).rows(), 3);
  EXPECT_EQ(content(path), header + line(1) + line(2) + line(7));
}

TEST(history, begins_anew_where_there_is_none_to_go_on_with) {
  const core::Comm comm;
  const std::string folder = scratch("history_anew"), foreign = folder + "/foreign.csv";
  EXPECT_EQ(History::go_on(folder + "/absent.csv", 5, comm).rows(), 0);
  EXPECT_EQ(content(folder + "/absent.csv"), header);
  comm.on_root([&] { std::ofstream(foreign) << "a,b\n1,2\n"; });
  EXPECT_EQ(History::go_on(foreign, 5, comm).rows(), 0);
  EXPECT_EQ(content(foreign), header);
  EXPECT_EQ(History::go_on(folder + "/none/history.csv", 5, comm, false).rows(), 0);
}

TEST(history, that_is_disabled_touches_no_file) {
  const core::Comm comm;
  const std::string folder = scratch("history_disabled");
  History history(folder + "/none/history.csv", comm, false);
  history.append(full_row());
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(history, that_can_not_be_written_is_an_error_on_all_ranks) {
  const core::Comm comm;
  const std::string folder = scratch("history_errors");
  const std::string absent = folder + "/none/history.csv", path = folder + "/history.csv";
  EXPECT_EQ(sentence_of(core::ExitCode::input_output, [&] { History(absent, comm); }),
            "The file '" + absent + "' can not be written: No such file or directory.");
  const std::string device = "The file '/dev/full' can not be written: there is no regular file of this name, and ";
  EXPECT_EQ(sentence_of(core::ExitCode::input_output, [&] { History("/dev/full", comm); }).substr(0, device.size()), device);
  History history(path, comm);
  const FullDisk full(header.size() + 3);
  EXPECT_EQ(sentence_of(core::ExitCode::input_output, [&] { history.append(full_row()); }),
            "The file '" + path + "' can not be written: File too large.");
}

}  // namespace thixis::output
