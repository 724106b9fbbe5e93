#pragma once

namespace hsgm::geometry {

/// A place on or above the WGS84 ellipsoid. Longitude and latitude are in degrees, because
/// the rational polynomials and PROJ take and give degrees; height is above the ellipsoid.
struct GeodeticPoint {
    double longitude_deg = 0;
    double latitude_deg = 0;
    double height_m = 0;
};

/// A place in a map grid: x to the east, y to the north, in metres; height above the
/// ellipsoid in metres, unless the map says otherwise.
struct MapPoint {
    double x = 0;
    double y = 0;
    double height_m = 0;
};

/// A place in an image: x counts columns (samples), y rows (lines), from 0 at the *centre* of
/// the first pixel.
struct ImagePoint {
    double x = 0;
    double y = 0;
};

/// Partial derivatives of an image point by the coordinates of a ground point, whose first
/// two are longitude and latitude in degrees, or x and y in metres; px per degree or metre.
struct ImageJacobian {
    double x_by_first = 0;
    double x_by_second = 0;
    double x_by_height = 0;
    double y_by_first = 0;
    double y_by_second = 0;
    double y_by_height = 0;
};

} // namespace hsgm::geometry
