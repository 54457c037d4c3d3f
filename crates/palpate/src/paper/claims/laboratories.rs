//! What laboratories would have concluded.

use crate::number::significant;
use crate::paper::{
    Ball, Claim, Comparison, Conclusion, Evidence, Laboratories, Method, Place, Readings, Relation, Reproduction,
    Share, Value,
};

/// The conclusion, fitted in one way, for both meanings of the instrument's accuracy.
pub(super) fn laboratories(
    study: &Reproduction,
    place: Place,
    conclusion: Conclusion,
    method: Method,
) -> impl Iterator<Item = Claim> {
    Readings::ALL.into_iter().map(move |readings| drawn(study, place, conclusion, method, readings))
}

fn with(study: &Reproduction, method: Method, readings: Readings) -> impl Iterator<Item = &Laboratories> {
    study.laboratories.iter().filter(move |labs| labs.method == method && labs.readings == readings)
}

/// A share of laboratories in percent, against the half that it has to exceed where a conclusion is true, and not to reach where it is false.
fn judged(quantity: String, truth: bool, share: Share) -> Comparison {
    let (low, high) = share.interval();
    let ours = Value {
        value: 100.0 * share.value(),
        interval: Some((100.0 * low, 100.0 * high)),
    };
    let (relation, reason) = if truth {
        (Relation::AtLeast, "drawn by more than half, with all of the 95 % interval, where it is true")
    } else {
        (Relation::AtMost, "drawn by less than half, with all of the 95 % interval, where it is false")
    };
    Comparison::new(quantity, "%", (50.0, relation, ours), (0.0, reason))
}

/// A conclusion, judged by how often laboratories draw it where it is true and where it is false.
fn drawn(study: &Reproduction, place: Place, conclusion: Conclusion, method: Method, readings: Readings) -> Claim {
    let comparisons = with(study, method, readings).filter_map(|labs| {
        let share = labs.share(conclusion);
        let quantity = format!("laboratories that conclude so, of {}; ball: {}", share.of, labs.ball.words());
        Some(judged(quantity, labs.ball.truth(conclusion)?, share))
    });
    let by = match method {
        Method::Rates => "strain rate fitted against strain, as in the paper",
        Method::Time => "closed form fitted against time",
    };
    let mut remark = match (method, readings) {
        (Method::Rates, Readings::Independent) => {
            "It depends on the sampling rate, on the smoothing of the derivative and on the error of single readings, none of which the paper states.".to_owned()
        }
        (_, Readings::Repeatable) => format!(
            "The paper calls the load cell of “high repeatability” without a number: {} N here.",
            significant(study.options.repeatability, 3)
        ),
        (Method::Time, Readings::Independent) => String::new(),
    };
    let linear = with(study, method, readings).find(|labs| labs.ball == Ball::Linear);
    remark.extend(linear.filter(|labs| labs.ball.truth(conclusion).is_none()).map(|labs| {
        let share = labs.share(conclusion);
        let (low, high) = share.interval();
        format!(
            " A linear viscoelastic ball, for which the law is not made, leads {} % to it (95 % interval {} to {} %).",
            significant(100.0 * share.value(), 2),
            significant(100.0 * low, 2),
            significant(100.0 * high, 2)
        )
    }));
    Claim::new(place, format!("{} ({by}; {} of the readings).", conclusion.words(), readings.words()))
        .compared(comparisons)
        .remark(remark.trim_start())
        .shown_by(Evidence::Table("laboratories"))
}

/// That the relation between strain and strain rate is nonlinear: what laboratories conclude of a ball that is linear.
pub(super) fn nonlinear(study: &Reproduction) -> Claim {
    let comparisons = Readings::ALL.into_iter().flat_map(|readings| {
        let linear = with(study, Method::Rates, readings).find(|labs| labs.ball == Ball::Linear);
        linear.map(|labs| {
            let of = labs.share(Conclusion::OrderFive).of;
            let quantity = format!(
                "laboratories with a linear viscoelastic ball that choose n > 1, of {of}; {} of the readings",
                readings.words()
            );
            let chosen: usize = labs.orders[1..].iter().sum();
            judged(quantity, false, Share { drawn: chosen, of })
        })
    });
    Claim::new(Place::Section("II"), "The experiments suggest that strain and strain rate are related nonlinearly.")
        .compared(comparisons)
        .remark("Strain rate over strain is a curve in figure 6, which the text of the source does not contain. A linear body with several relaxation times gives a curve too: it does not tell a nonlinear body from a linear one.")
        .shown_by(Evidence::Table("orders"))
}
