#pragma once

#include <string>

#include "corrector/gravimeter/gravimeter_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"

/// Lines as the three makes write them, with made-up numbers.
namespace a351::corrector::gravimeter::made_up {

inline GravimeterFile read(const std::string& content) {
    const test::TemporaryDirectory folder;
    return read_gravimeter_file(folder.write("no-name", content));
}

/// Returns the text with the first of some words replaced.
inline std::string changed(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

inline std::string kept(const Reading& reading, const std::string& name) {
    for (const auto& [key, text] : reading.kept)
        if (key == name) return text;
    return "not kept";
}

inline std::string cg5_header(const std::string& gmt_diff, const std::string& tide = "YES",
                              const std::string& serial = "123") {
    return "/\tCG-5 SURVEY\r\n/\tInstrument S/N:\t" + serial +
           "\r\n/\tLONG:        \t70.5 W\r\n/\tLAT:         \t33.25 S\r\n/\tGMT DIFF.:   \t" +
           gmt_diff + "\r\n/\tTide Correction:    " + tide + "\r\n\r\nLine\t   0.000S\r\n";
}

inline std::string cg5_reading(const std::string& station, const std::string& time,
                               const std::string& value = "2000.000") {
    return " 0.0 " + station + " 12.5 " + value + " 0.010 0.1 -0.2 -1.5 0.020 60 3 " + time +
           " 41500.1 0.0000 2013/09/15\r\n";
}

inline std::string cg6_header(const std::string& serial = "77") {
    return "/\t\tCG-6 Survey\n/\t\tInstrument Serial Number:\t" + serial +
           "\n/\n/"
           "Station\tDate\tTime\tCorrGrav\tLine\tStdDev\tX\tY\tSensorTemp\tTideCorr\tTiltCorr\t"
           "TempCorr\tDriftCorr\tMeasurDur\tInstrHeight\tLatUser\tLonUser\tElevUser\tLatGPS\tLonGPS"
           "\t"
           "ElevGPS\tCorrections[drift-temp-na-tide-tilt]\n";
}

inline std::string cg6_reading(const std::string& station, const std::string& time,
                               const std::string& flags = "11011") {
    return station + "\t2017-04-17\t" + time +
           "\t2066.1898\t1\t0.0128\t0.9\t1.5\t43.2662\t-0.0488\t0.0001\t5.4077\t2.3088\t60\t0.25\t-"
           "-\t"
           "--\t--\t39.5\t-105.0\t1577.0\t" +
           flags + "\n";
}

inline std::string burris_reading(const std::string& station, const std::string& time,
                                  const std::string& dial = "2800", char separator = ' ',
                                  const std::string& meter = "B44") {
    std::string line = station + " abc " + meter + " 2017/12/05 " + time + " 2769.695 " + dial +
                       " 0.482 -0.103 0.005 -0.033 -0.002 0.1 1600 35.1 -106.6";
    for (char& letter : line)
        if (letter == ' ') letter = separator;
    return line + "\n";
}

}  // namespace a351::corrector::gravimeter::made_up
