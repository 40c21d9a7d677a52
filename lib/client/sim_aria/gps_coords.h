// SPDX-License-Identifier: GPL-3.0-or-later
// WGS 84: half axis 6378137 m, squared eccentricity 6.69437999014e-3. To the map in closed form,
// over earth-fixed coordinates; back by eight rounds of a fixed point, exact to rounding but near
// the poles, where the altitude loses digits.
#ifndef SIM_ARIA_GPS_COORDS_H
#define SIM_ARIA_GPS_COORDS_H

#include <cmath>

#include <sim_aria/math.h>

/// Latitude and longitude in degrees, altitude over the ellipsoid in metres (WGS 84).
class ArLLACoords {
  public:
    ArLLACoords() {}
    ArLLACoords(double latitude, double longitude, double altitude)
        : myLatitude(latitude), myLongitude(longitude), myAltitude(altitude) {}
    double getLatitude() const { return myLatitude; }
    double getLongitude() const { return myLongitude; }
    double getAltitude() const { return myAltitude; }
    void setLatitude(double degrees) { myLatitude = degrees; }
    void setLongitude(double degrees) { myLongitude = degrees; }
    void setAltitude(double metres) { myAltitude = metres; }

  private:
    double myLatitude = 0, myLongitude = 0, myAltitude = 0;
};

/// Positions in a map whose origin lies at a place on the earth: x to the east, y to the north, z
/// up, mm; on the plane that touches the ellipsoid there.
class ArMapGPSCoords {
  public:
    explicit ArMapGPSCoords(ArLLACoords origin) : myOrigin(origin), myCentre(cartesian(origin)) {}

    void convertLLA2MapCoords(double latitude, double longitude, double altitude, double& east,
                              double& north, double& up) const {
        const Vector at = cartesian(ArLLACoords(latitude, longitude, altitude));
        const double x = at.x - myCentre.x, y = at.y - myCentre.y, z = at.z - myCentre.z;
        const Frame f = frame();
        constexpr double kMm = 1000;
        east = kMm * (-f.sin_lon * x + f.cos_lon * y);
        north = kMm * (-f.sin_lat * (f.cos_lon * x + f.sin_lon * y) + f.cos_lat * z);
        up = kMm * (f.cos_lat * (f.cos_lon * x + f.sin_lon * y) + f.sin_lat * z);
    }
    void convertLLA2MapCoords(const ArLLACoords& place, double& east, double& north,
                              double& up) const {
        convertLLA2MapCoords(place.getLatitude(), place.getLongitude(), place.getAltitude(), east,
                             north, up);
    }
    void convertMap2LLACoords(double east, double north, double up, double& latitude,
                              double& longitude, double& altitude) const {
        constexpr double kMetre = 0.001;
        const double e = kMetre * east, n = kMetre * north, u = kMetre * up;
        const Frame f = frame();
        const double out = f.cos_lat * u - f.sin_lat * n;  // from the axis of the earth
        const double x = myCentre.x + f.cos_lon * out - f.sin_lon * e;
        const double y = myCentre.y + f.sin_lon * out + f.cos_lon * e;
        const double z = myCentre.z + f.sin_lat * u + f.cos_lat * n;
        longitude = ArMath::atan2(y, x);
        const double axis = std::hypot(x, y);
        double lat = std::atan2(z, axis * (1 - kExcentricity));
        altitude = 0;
        // Each round gains some three digits.
        for (int i = 0; i < 8; ++i) {
            const double radius = curvature(std::sin(lat));
            altitude = axis / std::cos(lat) - radius;
            lat = std::atan2(z, axis * (1 - kExcentricity * radius / (radius + altitude)));
        }
        latitude = ArMath::radToDeg(lat);
    }

  private:
    struct Vector {
        double x, y, z;  // m from the middle of the earth
    };
    struct Frame {
        double sin_lat, cos_lat, sin_lon, cos_lon;
    };
    static constexpr double kRadius = 6378137, kExcentricity = 6.69437999014e-3;  // the square

    static double curvature(double sin_lat) {
        return kRadius / std::sqrt(1 - kExcentricity * sin_lat * sin_lat);
    }
    static Vector cartesian(const ArLLACoords& at) {
        const double s = ArMath::sin(at.getLatitude()), c = ArMath::cos(at.getLatitude());
        const double radius = curvature(s);
        return {(radius + at.getAltitude()) * c * ArMath::cos(at.getLongitude()),
                (radius + at.getAltitude()) * c * ArMath::sin(at.getLongitude()),
                (radius * (1 - kExcentricity) + at.getAltitude()) * s};
    }
    Frame frame() const {
        return {ArMath::sin(myOrigin.getLatitude()), ArMath::cos(myOrigin.getLatitude()),
                ArMath::sin(myOrigin.getLongitude()), ArMath::cos(myOrigin.getLongitude())};
    }

    ArLLACoords myOrigin;
    Vector myCentre;
};

#endif  // SIM_ARIA_GPS_COORDS_H
