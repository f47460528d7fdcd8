#include "xdmf.hpp"

#include <fmt/core.h>

#include "grid.hpp"

namespace thixis::output {
namespace {

std::string data_item(const std::string& dimensions, const char* type, const std::string& address) {
  return fmt::format(R"(<DataItem Dimensions="{}" NumberType="{}" Precision="8" Format="HDF">{}</DataItem>)", dimensions, type, address);
}

std::string document(const std::string& domain) {
  return "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n" + domain + "</Domain>\n</Xdmf>\n";
}

const char* topology(int corners) {
  return corners == 2 ? R"("Polyline" NodesPerElement="2")" : corners == 3 ? R"("Triangle")" : R"("Quadrilateral")";
}

}  // namespace

std::string cell_array(int corners) { return std::string(cell_name(corners)) + "s"; }

std::string xdmf_grid(const XdmfGrid& grid, bool with_time) {
  const std::string mesh = fmt::format("{}:/mesh_{}", grid.mesh_file, grid.mesh);
  std::string text = fmt::format("<Grid Name=\"grid {}\" GridType=\"Uniform\">\n", grid.number);
  if (with_time) text += fmt::format("  <Time Value=\"{}\"/>\n", grid.time);
  text += fmt::format("  <Topology TopologyType={} NumberOfElements=\"{}\">{}</Topology>\n", topology(grid.corners), grid.cells,
                      data_item(fmt::format("{} {}", grid.cells, grid.corners), "Int", mesh + "/" + cell_array(grid.corners)));
  text += fmt::format("  <Geometry GeometryType=\"XY\">{}</Geometry>\n",
                      data_item(fmt::format("{} 2", grid.points), "Float", mesh + "/points"));
  for (const XdmfAttribute& attribute : grid.attributes) {
    const bool cell = attribute.centre == Centre::cell, scalar = attribute.columns == 1;
    const GlobalIndex rows = cell ? grid.cells : grid.points;
    const std::string dimensions = scalar ? fmt::format("{}", rows) : fmt::format("{} {}", rows, attribute.columns);
    text += fmt::format("  <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n", attribute.name,
                        scalar ? "Scalar" : "Vector", cell ? "Cell" : "Node",
                        data_item(dimensions, "Float", fmt::format("{}:/fields_{}/{}", grid.file, grid.number, attribute.name)));
  }
  return text + "</Grid>\n";
}

std::string xdmf_single(const std::string& grid) { return document(grid); }

std::string xdmf_series(const std::string& grids) {
  return document("<Grid Name=\"series\" GridType=\"Collection\" CollectionType=\"Temporal\">\n" + grids + "</Grid>\n");
}

}  // namespace thixis::output
