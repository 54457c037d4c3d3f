//! What laboratories would have concluded.

use crate::number::significant;
use crate::paper::{Ball, Claim, Comparison, Conclusion, Evidence, Method, Place, Relation, Reproduction, Value};

/// A conclusion, judged by how often laboratories draw it where it is true and where it is false.
pub(super) fn laboratories(study: &Reproduction, place: Place, conclusion: Conclusion, method: Method) -> Claim {
    let of_method = || study.laboratories.iter().filter(|labs| labs.method == method);
    let judged = of_method().filter(|labs| labs.ball != Ball::Linear || conclusion == Conclusion::OrderFive);
    let comparisons = judged.filter_map(|labs| {
        let truth = labs.ball.truth(conclusion)?;
        let share = labs.share(conclusion);
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
        let quantity = format!("laboratories that conclude so, of {}; ball: {}", share.of, labs.ball.words());
        Some(Comparison::new(quantity, "%", (50.0, relation, ours), (0.0, reason)))
    });
    let linear = of_method().find(|labs| labs.ball == Ball::Linear).filter(|_| conclusion != Conclusion::OrderFive);
    let by = match method {
        Method::Rates => "strain rate fitted against strain, as in the paper",
        Method::Time => "closed form fitted against time",
    };
    let mut remark = match method {
        Method::Rates => "The result depends on the sampling rate and on the smoothing of the derivative, neither of which the paper states.".to_owned(),
        Method::Time => String::new(),
    };
    remark.extend(linear.map(|labs| {
        let share = labs.share(conclusion);
        let (low, high) = share.interval();
        format!(
            " A linear viscoelastic ball, for which the law is not made, leads {} % to it (95 % interval {} to {} %).",
            significant(100.0 * share.value(), 2),
            significant(100.0 * low, 2),
            significant(100.0 * high, 2)
        )
    }));
    Claim::new(place, format!("{} ({by}).", conclusion.words()))
        .compared(comparisons)
        .remark(remark.trim_start())
        .shown_by(Evidence::Table("laboratories"))
}
