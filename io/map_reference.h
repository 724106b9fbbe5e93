#pragma once

#include <string>

namespace hsgm::io {

/// Whether two coordinate reference systems, as WKT, are the same but for their wording. Two
/// unknown ones (empty) are the same, an unknown and a known one are not.
bool same_crs(const std::string& wkt, const std::string& other_wkt);

/// Whether coordinates are degrees: true for a geographic reference system, as WKT.
bool in_degrees(const std::string& wkt);

/// For people: the name of a reference system, "no coordinate reference system" for none.
std::string crs_name(const std::string& wkt);

} // namespace hsgm::io
