#include "thixis/output/probes.hpp"

#include <fmt/format.h>

#include "files/text_file.hpp"

namespace thixis::output {

void write_probes(const std::string& path, const std::vector<std::array<double, 2>>& points, const std::vector<std::string>& fields,
                  const std::vector<double>& values, const core::Comm& comm) {
  comm.on_root([&] {
    std::string text = fmt::format("x,y,{}\n", fmt::join(fields, ","));
    for (std::size_t i = 0; i < points.size(); ++i) {
      text += fmt::format("{},{}", points[i][0], points[i][1]);
      for (std::size_t k = 0; k < fields.size(); ++k) text += fmt::format(",{}", values[i * fields.size() + k]);
      text += "\n";
    }
    write_text(path, text);
  });
}

}  // namespace thixis::output
