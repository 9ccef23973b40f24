#include "fathom/harness/conformance.hpp"

#include <exception>

#include "clauses.hpp"
#include "expectations.hpp"
#include "fathom/core/environment_error.hpp"

namespace fathom {
namespace {

using conformance::Clause;
using conformance::Subject;

const std::vector<Clause>& clauses() {
  static const std::vector<Clause> all = [] {
    std::vector<Clause> joined;
    for (const auto part :
         {conformance::estimate_clauses, conformance::failure_clauses, conformance::loop_clauses,
          conformance::covariance_clauses, conformance::absolute_clauses,
          conformance::world_clauses, conformance::shared_clauses, conformance::hole_clauses}) {
      for (Clause& clause : part()) joined.push_back(std::move(clause));
    }
    return joined;
  }();
  return all;
}

const Clause& clause_named(const std::string& name) {
  std::vector<std::string> names;
  for (const Clause& clause : clauses()) {
    if (clause.stated.name == name) return clause;
    names.push_back(clause.stated.name);
  }
  throw InputError("unknown clause '" + name + "'" + suggestion(name, names));
}

ConformanceVerdict broken(std::string how) {
  for (char& letter : how) {
    if (letter == '\n' || letter == '\r') letter = ' ';
  }
  return {Conformity::broken, std::move(how)};
}

// A fault comes first: what followed from it is no reason.
ConformanceVerdict verdict_of(const Clause& clause, Subject& subject) {
  try {
    clause.check(subject);
  } catch (const conformance::NotApplicable& reason) {
    return {Conformity::not_applicable, reason.what()};
  } catch (const conformance::Broken& how) {
    const std::string fault = subject.fault();
    return broken(fault.empty() ? how.what() : fault);
  } catch (const EnvironmentError&) {
    throw;
  } catch (const std::exception& error) {
    return broken(std::string("threw an exception: ") + error.what());
  } catch (...) {
    return broken("threw what is no std::exception");
  }
  const std::string fault = subject.fault();
  return fault.empty() ? ConformanceVerdict{} : broken(fault);
}

}  // namespace

const std::vector<ConformanceClause>& conformance_clauses() {
  static const std::vector<ConformanceClause> stated = [] {
    std::vector<ConformanceClause> all;
    for (const Clause& clause : clauses()) all.push_back(clause.stated);
    return all;
  }();
  return stated;
}

ConformanceVerdict conformance_of(const EstimatorEntry& estimator, const std::string& clause) {
  const Clause& held = clause_named(clause);
  Subject subject(estimator);
  return verdict_of(held, subject);
}

}  // namespace fathom
