#pragma once

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <map>
#include <memory>
#include <set>

#include "corrector/adjustment/helmert_block.hpp"
#include "tests/unit/whole_day/made_up_day.hpp"

/// Random problems of several surveys, and their solution by plain dense matrices in long double: all
/// readings at once, those with white noise too, the noise as a covariance, every unknown a column.
/// It shares no code with the adjustment.
namespace a351::corrector::whole_day {

using reading::DayBin;
using reading::DayRecord;

using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// Readings with white noise, a constant, a drift and a slope by temperature; the slope may have a prior.
struct WhiteReadings {
    std::vector<corrector::reading::SurveyRow> rows;
    double sd_mgal = 1.0;
    std::optional<corrector::adjustment::Prior> slope_prior;
    [[nodiscard]] std::size_t site_of(std::size_t row) const {
        return static_cast<std::size_t>(std::stoi(rows[row].site));
    }
};

/// Surveys at a point that is given.
struct RandomDays {
    std::vector<std::unique_ptr<DayRecord>> records;
    std::vector<WhiteReadings> white;
    std::vector<std::optional<double>>
        u_held;                     ///< Uncertainty of each reference that is held, mGal.
    std::vector<double> base_mgal;  ///< Gravities from which estimates count.
    std::shared_ptr<const DayProblem> problem;
    DayPoint point;
};

/// Returns a made-up day of a few bins, a number of days later; some days are in two faces.
inline std::unique_ptr<DayRecord> day_of(std::uint64_t seed, std::size_t bins_of_set_up, int days) {
    auto record = std::make_unique<DayRecord>(later(kScattered.record(seed), days * kOneDay));
    std::vector<DayBin> kept;
    for (std::size_t i = 0; i < record->bins.size(); ++i) {
        if (i % MadeUpDay::kBins >= bins_of_set_up) continue;
        DayBin bin = record->bins[i];
        if (seed % 3 == 0) bin.face = (bin.set_up + seed) % 4 < 2 ? 1.0 : -1.0;
        bin.y = StandardGravity(0.001 * std::sin(1.7 * static_cast<double>(bin.set_up + seed)));
        kept.push_back(std::move(bin));
    }
    record->bins = std::move(kept);
    return record;
}

inline WhiteReadings white_readings(std::uint64_t seed, std::size_t fewest) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform;
    WhiteReadings readings;
    readings.sd_mgal = 0.01 * std::pow(1e3, uniform(random));
    const std::size_t count = fewest + static_cast<std::size_t>(15.0 * uniform(random));
    for (std::size_t i = 0; i < count; ++i) {
        corrector::reading::SurveyRow& row = readings.rows.emplace_back();
        row.site = std::to_string(
            static_cast<std::size_t>(static_cast<double>(MadeUpDay::kSites) * uniform(random)));
        row.time = MadeUpDay::start() + std::chrono::minutes(20 * static_cast<int>(i));
        row.temperature = DegC(42.0 + uniform(random));
        row.acceleration =
            MilliGal(MadeUpDay::gravity_mgal(static_cast<std::size_t>(std::stoi(row.site))) +
                     1500.0 + 5.0 * uniform(random));
        // They make the survey determined; the joint adjustment has references of its own.
        row.reference = MilliGal(979900.0 + 100.0 * uniform(random));
    }
    if (uniform(random) < 0.5)
        readings.slope_prior = {40.0 * uniform(random) - 20.0,
                                0.01 * std::pow(1e4, uniform(random))};
    return readings;
}

/// Returns the readings as a part of an adjustment.
inline WhiteSurvey white_survey(const WhiteReadings& readings,
                         const std::vector<std::optional<double>>& u_held) {
    using namespace corrector::adjustment;
    SurveyKnowledge knowledge;
    knowledge.priors.reading_sd_mgal = readings.sd_mgal;
    knowledge.sd_of_reference = MilliGal(10.0);
    if (readings.slope_prior)
        knowledge.priors.values.emplace(kTemperature.name, *readings.slope_prior);
    const AdjustedSurvey adjusted = adjust(
        SurveyEquations(readings.rows, std::vector<bool>(readings.rows.size(), true),
                        {"white", {&kConstant, &kTime, &kTemperature}, false, false}, knowledge));
    WhiteSurvey survey{helmert_block(adjusted).value(), {}};
    for (const EquationStation& of : adjusted.survey.stations()) {
        DayStation& station = survey.stations.emplace_back();
        station.number = static_cast<std::size_t>(std::stoi(of.site));
        if (!u_held[station.number]) continue;
        station.gravity = MilliGal(MadeUpDay::gravity_mgal(station.number));
        station.u_gravity = MilliGal(*u_held[station.number]);
    }
    return survey;
}

/// @param lag_factor  factor of the deviations of the lags' priors.
inline RandomDays random_days(std::uint64_t seed, double lag_factor) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform;
    const auto number = [&](std::size_t below) {
        return static_cast<std::size_t>(uniform(random) * static_cast<double>(below));
    };
    RandomDays days;
    const std::size_t white_count = seed % 3;
    const std::size_t count = white_count > 0 && seed % 5 == 0 ? 0 : 1 + number(4);
    for (std::size_t k = 0; k < white_count; ++k)
        days.white.push_back(white_readings(1000 * seed + k, count > 0 ? 6 : 20));
    const bool is_one_unit = uniform(random) < 0.5;
    const bool is_box = !is_one_unit && uniform(random) < 0.5;
    const std::size_t steps = number(3);
    std::vector<std::optional<double>>& u_held = days.u_held;
    u_held.resize(MadeUpDay::kSites);
    for (auto& u : u_held)
        if (uniform(random) < 0.4)
            u = uniform(random) < 0.5 ? 0.0 : 0.001 * std::pow(1e6, uniform(random));
    u_held[number(MadeUpDay::kSites)] = 0.0;
    // White readings alone need more of them, or a gravity is left to its prior of 1e4 mGal.
    if (count == 0) u_held[0] = u_held[3] = u_held[6] = u_held[9] = 0.0;
    std::vector<DaySurvey> surveys;
    std::vector<double> rough_mgal;
    for (std::size_t site = 0; site < MadeUpDay::kSites; ++site)
        rough_mgal.push_back(u_held[site] ? 0.0
                                          : MadeUpDay::gravity_mgal(site) + 2.0 * uniform(random));
    const double tight = std::pow(10.0, -2.0 * uniform(random));
    for (std::size_t k = 0; k < count; ++k) {
        days.records.push_back(day_of(100 * seed + k, 2, is_box ? 0 : static_cast<int>(k)));
        DaySurvey& survey = surveys.emplace_back();
        survey.record = days.records.back().get();
        survey.unit = is_one_unit ? 0 : k;
        survey.stations = MadeUpDay::stations();
        for (std::size_t s = 0; s < survey.stations.size(); ++s) {
            DayStation& station = survey.stations[s];
            station.steps = steps * s / survey.stations.size();
            station.u_gravity = MilliGal(u_held[station.number].value_or(0.0));
            if (!u_held[station.number]) station.gravity.reset();
        }
        for (std::size_t site = 0; site < MadeUpDay::kSites; ++site)
            survey.gravities.push_back(site);
        survey.priors.factor *= tight;
        survey.priors.factor.topRows<kLags>() *= lag_factor / tight;
        survey.priors.factor(DayPriors::place_of(DayTerm::constant),
                             DayPriors::place_of(DayTerm::constant)) = kFreeGravity_mgal;
    }
    std::vector<WhiteSurvey> white_surveys;
    for (const WhiteReadings& readings : days.white)
        white_surveys.push_back(white_survey(readings, u_held));
    for (std::size_t site = 0; site < MadeUpDay::kSites; ++site)
        days.base_mgal.push_back(u_held[site] ? MadeUpDay::gravity_mgal(site) : rough_mgal[site]);
    days.problem = std::make_shared<const DayProblem>(std::move(surveys), rough_mgal,
                                                      std::move(white_surveys));
    for (std::size_t i = 0; i < days.problem->hypers().size(); ++i)
        days.point.u.push_back(2.0 * uniform(random) - 1.0);
    if (days.problem->has_boxes()) days.point.share = uniform(random);
    return days;
}

/// All readings with one column for each unknown, in units of the standard deviations of the priors.
class Dense {
public:
    explicit Dense(const RandomDays& days) : days_(days) {
        const DayProblem& problem = *days.problem;
        Eigen::Index rows = 0;
        for (const DaySurvey& survey : problem.surveys()) rows += std::ssize(survey.record->bins);
        for (const WhiteReadings& white : days.white) rows += std::ssize(white.rows);
        readings_ = Vector::Zero(rows);
        noise_ = Matrix::Zero(rows, rows);
        Eigen::Index begin = 0;
        for (std::size_t k = 0; k < problem.surveys().size(); ++k) add(k, begin, rows);
        for (std::size_t k = 0; k < days.white.size(); ++k) add_white(k, begin, rows);
        add_box();
        root_ = Eigen::LLT<Matrix>(noise_).matrixL();
        root_.triangularView<Eigen::Lower>().solveInPlace(readings_);
        for (auto& [name, column] : columns_)
            root_.triangularView<Eigen::Lower>().solveInPlace(column);
    }

    /// Adds the derivatives of the readings by the lags, by finite differences of the whole model.
    void add_lags(const DayAdjustment& adjustment) {
        const DayProblem& problem = *days_.problem;
        std::map<std::string, Vector> lags;
        Eigen::Index begin = 0;
        for (std::size_t k = 0; k < problem.surveys().size(); ++k) {
            const DayRegression& regression = problem.of(k);
            const DayFit fit = adjustment.fit(k);
            const Eigen::Index count = std::ssize(problem.surveys()[k].record->bins);
            for (const DayHyper lag : {kFastLag, kSlowLag}) {
                const auto effects = [&](double move) -> Eigen::VectorXd {
                    SurveyPoint u = fit.point;
                    u.at(lag) += move;
                    return faces_of(problem.surveys()[k])
                        .cwiseProduct(regression.design(u) *
                                      regression.unscaled(
                                          u, adjustment.scaled(k).head(regression.estimated())));
                };
                constexpr double kStep = 0.1;
                lags.emplace("unit " + std::to_string(problem.surveys()[k].unit) + " lag " +
                                 std::to_string(lag),
                             Vector::Zero(readings_.size()))
                    .first->second.segment(begin, count) =
                    ((effects(kStep) - effects(-kStep)) / (2.0 * kStep)).cast<Real>();
            }
            begin += count;
        }
        for (auto& [name, column] : lags) {
            root_.triangularView<Eigen::Lower>().solveInPlace(column);
            columns_[name] = column;
        }
    }

    struct Solution {
        std::vector<std::string> names;
        Vector values;
        Matrix covariance;
        Real twice_cost = 0.0L;  ///< ln det N + ln det(X'N^-1 X + 1) + y'(N + X X')^-1 y + u'u
    };

    /// Returns the least-squares solution by a QR decomposition of the rows and the priors.
    /// @param without  names of columns that are not in the system.
    [[nodiscard]] Solution solve(const std::set<std::string>& without) const {
        Solution solution;
        for (const auto& [name, column] : columns_)
            if (!without.contains(name)) solution.names.push_back(name);
        const Eigen::Index rows = readings_.size(), count = std::ssize(solution.names);
        Matrix all = Matrix::Zero(rows + count, count);
        for (Eigen::Index k = 0; k < count; ++k) {
            all.col(k).head(rows) = columns_.at(solution.names[static_cast<std::size_t>(k)]);
            all(rows + k, k) = 1.0L;
        }
        Vector right = Vector::Zero(rows + count);
        right.head(rows) = readings_;
        const Eigen::HouseholderQR<Matrix> qr(all);
        solution.values = qr.solve(right);
        const Matrix r = qr.matrixQR().topRows(count);
        const Matrix inverse =
            r.triangularView<Eigen::Upper>().solve(Matrix::Identity(count, count));
        solution.covariance = inverse * inverse.transpose();
        solution.twice_cost = 2.0L * root_.diagonal().array().log().sum() +
                              2.0L * r.diagonal().array().abs().log().sum() +
                              (right - all * solution.values).squaredNorm();
        for (const double u : days_.point.u) solution.twice_cost += u * u;
        return solution;
    }

    [[nodiscard]] bool has(std::size_t site) const { return columns_.contains(own(site)); }

    static std::string gravity(std::size_t site) { return "gravity " + std::to_string(site); }
    static std::string own(std::size_t site) { return "own " + std::to_string(site); }

private:
    /// Returns the faces of the bins.  The rows of the regression have their sign, these have not.
    static Eigen::VectorXd faces_of(const DaySurvey& survey) {
        Eigen::VectorXd faces(std::ssize(survey.record->bins));
        for (Eigen::Index i = 0; i < faces.size(); ++i)
            faces(i) = survey.record->bins[static_cast<std::size_t>(i)].face;
        return faces;
    }

    void add(std::size_t k, Eigen::Index& begin, Eigen::Index rows) {
        const DayProblem& problem = *days_.problem;
        const DaySurvey& survey = problem.surveys()[k];
        const DayRegression& regression = problem.of(k);
        const SurveyPoint u = problem.part_of(days_.point, k);
        const Eigen::Index count = std::ssize(survey.record->bins);
        const Eigen::VectorXd faces = faces_of(survey);
        const Eigen::MatrixXd scaled = faces.asDiagonal() * regression.scaled(u);
        readings_.segment(begin, count) = scaled.col(0).cast<Real>();
        noise_.block(begin, begin, count, count) =
            (faces.asDiagonal() *
             NoiseCovariance(survey.record->bins).at(problem.own_noise(days_.point, k)) *
             faces.asDiagonal())
                .cast<Real>();
        const auto column = [&](const std::string& name, const Eigen::VectorXd& values) {
            columns_.emplace(name, Vector::Zero(rows)).first->second.segment(begin, count) +=
                values.cast<Real>();
        };
        const std::string of_survey = "survey " + std::to_string(k) + " ",
                          of_unit = "unit " + std::to_string(survey.unit) + " ";
        const std::set<DayTerm> own_terms{DayTerm::constant, DayTerm::drift, DayTerm::warm_up};
        for (Eigen::Index term = 0; term < kTerms; ++term)
            column((own_terms.contains(static_cast<DayTerm>(term)) ? of_survey : of_unit) +
                       std::to_string(term),
                   scaled.col(term + 1));
        for (Eigen::Index step = regression.steps_begin(); step < regression.states_begin(); ++step)
            column(of_survey + "step " + std::to_string(step), scaled.col(step + 1));
        for (Eigen::Index at = regression.outer_begin(); at < regression.on_scale_begin(); ++at)
            column(of_unit + "outer " + std::to_string(at), scaled.col(at + 1));
        for (Eigen::Index share = 0; share < regression.on_scale(); ++share)
            column(of_unit + "on scale " + std::to_string(share),
                   scaled.col(1 + regression.on_scale_begin() + share));
        for (std::size_t site = 0; site < survey.gravities.size(); ++site) {
            Eigen::VectorXd ones = Eigen::VectorXd::Zero(count);
            for (Eigen::Index i = 0; i < count; ++i)
                if (survey.stations[survey.record->bins[static_cast<std::size_t>(i)].set_up]
                        .number == site)
                    ones(i) = 1.0;
            if (const Eigen::Index place = regression.place_of(site); place >= 0)
                column(gravity(site), scaled.col(place + 1));
            column(own(site), kFreeGravity_mgal * ones);
        }
        begin += count;
    }

    void add_white(std::size_t k, Eigen::Index& begin, Eigen::Index rows) {
        const WhiteReadings& white = days_.white[k];
        for (std::size_t i = 0; i < white.rows.size(); ++i, ++begin) {
            const corrector::reading::SurveyRow& row = white.rows[i];
            const std::size_t site = white.site_of(i);
            const auto set = [&](const std::string& name, Real value) {
                columns_.emplace(name, Vector::Zero(rows)).first->second(begin) = value;
            };
            readings_(begin) = row.acceleration.value() - days_.base_mgal[site];
            noise_(begin, begin) = std::pow(static_cast<Real>(white.sd_mgal), 2);
            const double deviation_mgal = days_.u_held[site].value_or(kFreeGravity_mgal);
            if (deviation_mgal > 0.0) set(gravity(site), deviation_mgal);
            set(own(site), kFreeGravity_mgal);
            // Every column has a prior of variance 1: a term without one has a column that is long.
            constexpr Real kFree = 1e8L;
            const std::string of_survey = "white " + std::to_string(k) + " ";
            set(of_survey + "constant", kFree);
            set(of_survey + "drift",
                kFree * static_cast<Real>(seconds_between(white.rows[0].time, row.time) / 3600.0));
            const Real degc = row.temperature.value() - 42.5;
            set(of_survey + "slope", degc * (white.slope_prior ? white.slope_prior->sd : kFree));
            if (white.slope_prior) readings_(begin) -= degc * white.slope_prior->mean;
        }
    }

    void add_box() {
        const DayProblem& problem = *days_.problem;
        if (!problem.has_boxes()) return;
        const double variance =
            days_.point.share *
            std::pow(problem.of(0).noise(problem.part_of(days_.point, 0)).placement_mgal, 2);
        const auto& bins = problem.surveys().front().record->bins;
        const auto count = static_cast<std::size_t>(bins.size());
        const Eigen::Index all = std::ssize(problem.surveys()) * std::ssize(bins);
        for (Eigen::Index i = 0; i < all; ++i)
            for (Eigen::Index j = 0; j < all; ++j)
                if (bins[static_cast<std::size_t>(i) % count].set_up ==
                    bins[static_cast<std::size_t>(j) % count].set_up)
                    noise_(i, j) += variance;
    }

    const RandomDays& days_;
    Vector readings_;
    Matrix noise_, root_;
    std::map<std::string, Vector> columns_;
};

}  // namespace a351::corrector::whole_day
