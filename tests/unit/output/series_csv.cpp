#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scratch.hpp"
#include "thixis/output/series.hpp"

namespace thixis::output {
namespace {

const std::vector<std::string> names{"s_g", "p_l_2"};
const std::string header = "time,s_g,p_l_2\n";

}  // namespace

TEST(series_csv, has_a_line_per_time_as_soon_as_it_is_appended) {
  const core::Comm comm;
  const std::string path = scratch("series_csv") + "/series.csv";
  Series series(path, names, comm);
  EXPECT_EQ(content(path), header);
  comm.barrier();
  series.append(0.1, {1.0 / 3, -INFINITY});
  EXPECT_EQ(content(path), header + "0.1,0.3333333333333333,-inf\n");
  comm.barrier();
  series.append(5000, {NAN, comm.root() ? 1e-300 : 2.0});
  EXPECT_EQ(content(path), header + "0.1,0.3333333333333333,-inf\n5000,nan,1e-300\n");
  EXPECT_EQ(series.rows(), 2);
}

TEST(series_csv, gives_back_every_double_exactly) {
  const core::Comm comm;
  const std::string path = scratch("series_csv_doubles") + "/series.csv";
  using Limits = std::numeric_limits<double>;
  const std::vector<double> values{0.1, 1 / 3.0, Limits::denorm_min(), Limits::max(), Limits::epsilon(), -0.0, 12623.0 * 365.25 * 86400};
  Series series(path, {"x"}, comm);
  for (const double value : values) series.append(value, {-value});
  std::istringstream text(content(path));
  std::string line;
  std::getline(text, line);
  for (const double value : values) {
    ASSERT_TRUE(std::getline(text, line));
    EXPECT_EQ(std::strtod(line.c_str(), nullptr), value) << line;
    EXPECT_EQ(std::strtod(line.c_str() + line.find(',') + 1, nullptr), -value) << line;
  }
}

TEST(series_csv, goes_on_behind_the_rows_that_are_to_stay) {
  const core::Comm comm;
  const std::string path = scratch("series_csv_goes_on") + "/series.csv";
  const auto append = [](Series& series, int from, int to) {
    for (int n = from; n < to; ++n) series.append(n / 3.0, {std::sin(n), std::exp(n)});
  };
  {
    Series whole(path, names, comm);
    append(whole, 0, 9);
  }
  const std::string expected = content(path);
  comm.barrier();
  for (const int kept : {9, 5, 1, 0}) {
    // cut off when the run was killed
    comm.on_root([&] { std::ofstream(path, std::ios::app) << "3,0.14"; });
    Series series = Series::go_on(path, names, kept, comm);
    EXPECT_EQ(series.rows(), kept);
    append(series, kept, 9);
    EXPECT_EQ(content(path), expected);
    comm.barrier();
  }
  EXPECT_EQ(Series::go_on(path, names, 20, comm).rows(), 9);
}

TEST(series_csv, begins_anew_where_there_is_none_to_go_on_with) {
  const core::Comm comm;
  const std::string folder = scratch("series_csv_anew"), path = folder + "/series.csv";
  EXPECT_EQ(Series::go_on(path, names, 5, comm).rows(), 0);
  EXPECT_EQ(content(path), header);
  comm.barrier();
  Series(path, {"other"}, comm).append(1, {1});
  EXPECT_EQ(Series::go_on(path, names, 1, comm).rows(), 0);
  EXPECT_EQ(content(path), header);
}

TEST(series_csv, refuses_names_and_rows_that_make_no_table) {
  const core::Comm comm;
  const std::string path = scratch("series_csv_refuses") + "/series.csv";
  const auto sentence = [&](const std::vector<std::string>& columns) {
    return sentence_of(core::ExitCode::internal, [&] { Series(path, columns, comm); });
  };
  for (const char* name : {"", "a b", "a,b", "p-l", "\xc3\xa9"})
    EXPECT_EQ(sentence({name}),
              "A column can not be called '" + std::string(name) + "': its name must be made of letters, digits and '_'.");
  EXPECT_EQ(sentence({"a", "b", "a"}), "Two columns are called 'a'.");
  EXPECT_EQ(sentence({"time"}), "Two columns are called 'time'.");
  EXPECT_FALSE(std::filesystem::exists(path));
  comm.barrier();
  Series series(path, names, comm);
  const bool spoiler = comm.rank() == comm.size() - 1;
  EXPECT_EQ(sentence_of(core::ExitCode::internal, [&] { series.append(0, std::vector<double>(spoiler ? 1 : 2)); }),
            "A row of the series has 1 values where 2 are needed.");
  EXPECT_EQ(content(path), header);
}

TEST(series_csv, that_can_not_be_written_is_an_error_on_all_ranks) {
  const core::Comm comm;
  const std::string absent = scratch("series_csv_errors") + "/none/series.csv";
  EXPECT_EQ(sentence_of(core::ExitCode::input_output, [&] { Series(absent, names, comm); }),
            "The file '" + absent + "' can not be written: No such file or directory.");
}

}  // namespace thixis::output
