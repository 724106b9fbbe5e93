#pragma once

#include "pipeline/geometry/points.h"

#include <memory>
#include <string>

namespace hsgm::geometry {

/// A map grid, joined to the WGS84 ellipsoid by PROJ. One for each thread: PROJ's objects may
/// not be shared; `copy` makes another. The network is never asked for grids.
class MapProjection {
public:
    /// The WGS84 / UTM zone of a place, or polar stereographic (UPS, axes east and north)
    /// beyond 84 degrees north and 80 south; heights are ellipsoidal.
    static MapProjection automatic(double longitude_deg, double latitude_deg);

    /// A coordinate reference system as PROJ understands it: "EPSG:32740", WKT, a PROJ string,
    /// "EPSG:32740+5773" with a vertical one. `vertical` adds one: "" (heights stay those above
    /// the ellipsoid), "EGM96", "EPSG:5773". Throws std::invalid_argument for text that PROJ
    /// does not know, a geocentric system, or one that it cannot reach without a grid that is
    /// not installed (which it names).
    static MapProjection from_text(const std::string& crs, const std::string& vertical = "");

    ~MapProjection();
    MapProjection(MapProjection&&) noexcept;
    MapProjection& operator=(MapProjection&&) noexcept;
    MapProjection copy() const;

    /// x to the east, y to the north in the map's units (degrees where it is geographic),
    /// height above its vertical datum in metres. Not finite for places that it does not reach.
    MapPoint forward(const GeodeticPoint& ground) const;
    GeodeticPoint inverse(const MapPoint& place) const;

    /// What `from_text` made it from, the vertical system joined by a plus sign.
    std::string text() const;
    /// For people: "WGS 84 / UTM zone 40S".
    const std::string& name() const;
    /// For people: "height above the WGS84 ellipsoid", "EGM96 height".
    const std::string& height_name() const;
    /// WKT2 as GDAL takes it; a compound system only where there is a vertical datum.
    const std::string& wkt() const;
    /// Both horizontal axes are in metres.
    bool in_metres() const;

private:
    struct Handles;
    explicit MapProjection(std::unique_ptr<Handles> handles);

    std::unique_ptr<Handles> handles_;
};

} // namespace hsgm::geometry
