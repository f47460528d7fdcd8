/// Maps and graphs of systems with several unknowns per node.
#include "thixis/algebra/tpetra.hpp"

namespace thixis::algebra {

MapPtr interlaced(const MapPtr& map, int fields) {
  if (fields == 1) return map;
  const LocalIndex count = local_size(*map);
  if (map->isContiguous())
    return Teuchos::rcp(
        new Map(fields * map->getGlobalNumElements(), static_cast<std::size_t>(fields) * count, map->getIndexBase(), map->getComm()));
  Teuchos::Array<GlobalIndex> ids(static_cast<std::size_t>(fields) * count);
  for (LocalIndex l = 0; l < count; ++l)
    for (int f = 0; f < fields; ++f) ids[fields * l + f] = fields * map->getGlobalElement(l) + f;
  return Teuchos::rcp(new Map(fields * map->getGlobalNumElements(), ids(), map->getIndexBase(), map->getComm()));
}

GraphPtr make_graph(const MapPtr& rows, const MapPtr& columns, const Graph::local_graph_device_type::row_map_type::non_const_type& row_map,
                    const Graph::local_graph_device_type::entries_type::non_const_type& entries) {
  const auto graph = Teuchos::rcp(new Graph(rows, columns, row_map, entries));
  graph->fillComplete(rows, rows);
  return graph;
}

}  // namespace thixis::algebra
