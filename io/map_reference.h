#pragma once

#include <string>

namespace hsgm::io {

/// Whether two coordinate reference systems, as WKT, are the same but for their wording. Two
/// unknown ones (empty) are the same, an unknown and a known one are not.
bool same_crs(const std::string& wkt, const std::string& other_wkt);

/// Whether coordinates are degrees: true for a geographic reference system, as WKT.
bool in_degrees(const std::string& wkt);

/// The reference system on the ground alone, without heights, as WKT; empty for none.
std::string horizontal_crs(const std::string& wkt);

/// Whether a reference system says what heights count from: a compound one, or one of three
/// dimensions.
bool has_heights(const std::string& wkt);

/// For people: the name of a reference system, "no coordinate reference system" for none.
std::string crs_name(const std::string& wkt);

} // namespace hsgm::io
