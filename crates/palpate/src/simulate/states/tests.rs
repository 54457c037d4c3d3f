//! Many contacts are as many contacts alone.

use super::*;
use crate::contact::{Equilibrium, Layers, Shape, Sides, Specimen};
use crate::latency::LatencyLaw;
use crate::simulate::{Contact, LinearContact, LinearLaw, LinearTerm, Memory, Separation, StepError};
use crate::test_problems::Rng;
use crate::vector::tests::on_every_level;

/// Bodies of every kind.
fn specimen(index: usize) -> Specimen {
    let size = 0.03 + 1e-4 * index as f64;
    let shape = match index % 4 {
        0 => Shape::Ball { radius: size },
        1 => Shape::Pad {
            radius: size,
            thickness: 0.8 * size,
        },
        2 => Shape::Prism {
            area: size * size,
            length: size,
        },
        _ => Shape::Ball { radius: 0.9 * size },
    };
    let sides = if index.is_multiple_of(3) { Sides::One } else { Sides::Two };
    let specimen = Specimen::new(shape, 2e4 + 1e3 * index as f64, sides).unwrap();
    match index % 4 {
        3 => specimen.with_equilibrium(Equilibrium::Hertz { poisson_ratio: 0.45 }).unwrap(),
        _ => specimen,
    }
}

fn separation(index: usize) -> Separation {
    if index.is_multiple_of(5) { Separation::Bonded } else { Separation::Unilateral }
}

/// Bodies of every kind, bonded and not, with exponents that have roots of their own and others.
fn models(exponents: &[f64], count: usize) -> Vec<ContactModel> {
    let model = |index: usize| {
        let exponent = exponents[index % exponents.len()];
        ContactModel {
            specimen: specimen(index),
            law: LatencyLaw::new(exponent, 1.5 * 10f64.powf(exponent - 1.0)).unwrap(),
            layers: Layers::new(8.0).unwrap(),
            separation: separation(index),
        }
    };
    (0..count).map(model).collect()
}

/// Linear contacts of one to three terms, that remember strain or force.
fn linear(index: usize) -> LinearContact {
    let term = |k: usize| LinearTerm {
        overshoot: 0.4 + 0.3 * k as f64,
        rate: 0.5 * 20f64.powi(k as i32),
    };
    let terms: Vec<LinearTerm> = (0..=index % 3).map(term).collect();
    LinearContact {
        specimen: specimen(index),
        law: LinearLaw::new(&terms).unwrap(),
        memory: if index.is_multiple_of(2) { Memory::Strain } else { Memory::Force },
        separation: separation(index),
    }
}

/// Displacements that wander; a bonded body whose contact grows cannot be pulled, any other can be left.
fn wander(places: &mut [f64], random: &mut Rng, is_bonded: impl Fn(usize) -> bool) {
    for (index, place) in places.iter_mut().enumerate() {
        let least = if is_bonded(index) { 1e-4 } else { -0.001 };
        *place = (*place + 1e-3 * (random.uniform() - 0.5)).clamp(least, 0.008);
    }
}

fn of_displacement<'a>(dt: &'a [f64], to: &'a [f64], substeps: u32, refusal: Refusal) -> ContactsStep<'a> {
    ContactsStep {
        imposed: Imposed::Displacement,
        dt,
        to,
        substeps,
        refusal,
    }
}

#[test]
fn contacts_side_by_side_are_contacts_alone() {
    for exponents in [&[5.0][..], &[1.0], &[2.0], &[3.0], &[0.6, 1.0, 2.7, 5.0, 11.3]] {
        let models = models(exponents, 43);
        let (mut together, mut alone) = (ContactStates::of_each(models.clone()), vec![ContactState::default(); 43]);
        let (mut random, mut places) = (Rng::new(3), vec![0.002; 43]);
        let mut left = 0;
        for _ in 0..400 {
            let dt = if random.uniform() < 0.1 { 0.0 } else { 0.01 * random.uniform() };
            wander(&mut places, &mut random, |index| models[index].separation == Separation::Bonded);
            let forces = together.step(&[dt], &places).unwrap();
            for (index, (state, model)) in alone.iter_mut().zip(&models).enumerate() {
                let force = state.step(model, dt, places[index]).unwrap();
                left += usize::from(!state.is_touching(model));
                let found = together.state(index);
                let scale = model.specimen.depth();
                let off = (found.behind - state.behind).abs() / scale;
                assert!(off < 1e-13 && found.jaw == state.jaw, "{exponents:?} {index}: {off:e}");
                assert!((forces[index] - force).abs() <= 1e-11 * force.abs().max(1e-2), "{exponents:?} {index}");
                if exponents == [5.0] {
                    assert_eq!((found, forces[index]), (*state, force), "{index}");
                }
            }
        }
        assert!(left > 100, "{exponents:?}: {left} steps without contact");
        shows_what_contacts_show(&together, &models);
    }
}

/// Contacts that stay in contact go several blocks at a time, up to one that leaves its body or is refused.
#[test]
fn closed_contacts_in_a_row_are_contacts_alone() {
    let count = 91;
    for exponent in [2.0, 3.0, 5.0] {
        let mut each = models(&[exponent], count);
        // Without bodies that are stepped alone, but for one.
        for (index, model) in each.iter_mut().enumerate().filter(|(index, _)| *index != 60) {
            model.specimen = specimen(index - usize::from(index % 4 == 3));
            model.separation = Separation::Unilateral;
        }
        for models in [each.clone(), vec![each[40].clone(); count]] {
            let is_one = models[0] == models[1];
            let found = on_every_level(|| {
                let mut together = match is_one {
                    true => ContactStates::alike(models[0].clone(), count),
                    false => ContactStates::of_each(models.clone()),
                };
                let (mut alone, mut forces) = (vec![ContactState::default(); count], vec![0.0; count]);
                let (mut random, mut places) = (Rng::new(5), vec![0.002; count]);
                let mut left = 0;
                for tick in 0..120 {
                    let mut dt: Vec<f64> = (0..count).map(|_| 0.01 * random.uniform()).collect();
                    dt.truncate(if tick % 2 == 0 { 1 } else { count });
                    wander(&mut places, &mut random, |index| index % 9 != 4);
                    let mut to = places.clone();
                    to[77] = if tick % 7 == 3 { f64::NAN } else { to[77] };
                    let failures =
                        together.advance(&of_displacement(&dt, &to, 1, Refusal::Masked), &mut forces).unwrap();
                    assert_eq!((failures == 1, together.failed()[77]), (to[77].is_nan(), to[77].is_nan()));
                    for (index, (state, model)) in alone.iter_mut().zip(&models).enumerate() {
                        let dt = dt[index.min(dt.len() - 1)];
                        let force = match state.step(model, dt, to[index]) {
                            Ok(force) => force,
                            Err(_) => state.force(model),
                        };
                        left += usize::from(!state.is_touching(model));
                        let found = together.state(index);
                        let off = (found.behind - state.behind).abs() / model.specimen.depth();
                        assert!(off < 1e-13 && found.jaw == state.jaw, "n = {exponent}, {index}: {off:e}");
                        assert!(
                            (forces[index] - force).abs() <= 1e-11 * force.abs().max(1e-2),
                            "n = {exponent}, {index}"
                        );
                        assert!(exponent != 5.0 || (found, forces[index]) == (*state, force), "{index}");
                    }
                }
                assert!(left > 20, "{left} steps without contact");
                [together.states(), &forces].concat()
            });
            assert_eq!(found.len(), 3 * count);
        }
    }
}

fn shows_what_contacts_show(together: &ContactStates, models: &[ContactModel]) {
    let mut shown = vec![0.0; together.count()];
    type Show = fn(&ContactState, &ContactModel) -> f64;
    let quantities: [(ContactQuantity, Show); 4] = [
        (ContactQuantity::Force, ContactState::force),
        (ContactQuantity::Stiffness, ContactState::stiffness),
        (ContactQuantity::Surface, ContactState::surface),
        (ContactQuantity::Touching, |state, model| f64::from(u8::from(state.is_touching(model)))),
    ];
    for (quantity, of) in quantities {
        together.models().show((together.states(), together.count()), quantity, 0, &mut shown);
        for (index, (found, model)) in shown.iter().zip(models).enumerate() {
            let expected = of(&together.state(index), model);
            assert!((found - expected).abs() <= 1e-14 * expected.abs(), "{quantity:?} {index}: {found} {expected}");
        }
    }
}

#[test]
fn substeps_are_steps_along_a_straight_line() {
    for exponents in [&[5.0][..], &[2.7, 1.0]] {
        let models = models(exponents, 21);
        let (mut parts, mut one_by_one) =
            (ContactStates::of_each(models.clone()), ContactStates::of_each(models.clone()));
        let (mut random, mut places, mut forces) = (Rng::new(8), vec![0.0; 21], vec![0.0; 21]);
        for _ in 0..50 {
            let before = places.clone();
            wander(&mut places, &mut random, |index| models[index].separation == Separation::Bonded);
            parts.advance(&of_displacement(&[0.04], &places, 4, Refusal::All), &mut forces).unwrap();
            for part in 1..=4 {
                let share = f64::from(part) / 4.0;
                let there: Vec<f64> = before
                    .iter()
                    .zip(&places)
                    .map(|(from, to)| if part == 4 { *to } else { from + share * (to - from) })
                    .collect();
                let found = one_by_one.step(&[0.01], &there).unwrap();
                if part == 4 {
                    for (force, found) in forces.iter().zip(found) {
                        assert!((force - found).abs() < 1e-10, "{force} {found}");
                    }
                }
            }
        }
    }
}

#[test]
fn contacts_that_are_open_or_leave_within_substeps_are_contacts_alone() {
    for exponents in [&[5.0][..], &[1.0], &[2.7]] {
        let models = models(exponents, 19);
        let (mut together, mut alone) = (ContactStates::of_each(models.clone()), vec![ContactState::default(); 19]);
        let (mut random, mut forces, mut open) = (Rng::new(21), vec![0.0; 19], 0);
        let mut places = vec![0.004; 19];
        for tick in 0..200 {
            // Half of the time far from the body, so that blocks are closed, open and both.
            let swing = 3e-3 * (0.05 * f64::from(tick)).sin();
            for (index, place) in places.iter_mut().enumerate() {
                let is_bonded = models[index].separation == Separation::Bonded;
                *place = if is_bonded { 1e-3 } else { 1e-3 * random.uniform() + swing };
            }
            together.advance(&of_displacement(&[0.04], &places, 4, Refusal::Masked), &mut forces).unwrap();
            for (index, (state, model)) in alone.iter_mut().zip(&models).enumerate() {
                let (from, mut force) = (state.jaw, 0.0);
                for part in 1..=4 {
                    let u = super::block::between(from, model.specimen.contact_displacement(places[index]), (part, 4));
                    force = state.step(model, 0.01, u / model.specimen.contact_displacement(1.0)).unwrap();
                }
                open += usize::from(!state.is_touching(model));
                let (found, depth) = (together.state(index), model.specimen.depth());
                assert!(
                    found.jaw == state.jaw && (found.behind - state.behind).abs() < 1e-13 * depth,
                    "{tick} {index}"
                );
                assert!((forces[index] - force).abs() <= 1e-10, "{tick} {index}: {} {force}", forces[index]);
                if exponents == [5.0] {
                    assert_eq!((found, forces[index]), (*state, force), "{tick} {index}");
                }
            }
        }
        assert!(open > 500, "{exponents:?}: {open} open contacts");
    }
}

#[test]
fn bodies_beyond_all_measure_are_refused_and_show_numbers() {
    let mut models = models(&[5.0], 9);
    models[1].specimen = Specimen::new(Shape::Ball { radius: 0.03 }, 1e308, Sides::Two).unwrap();
    models[4].layers = Layers::new(1e306).unwrap();
    let mut contacts = ContactStates::of_each(models);
    let mut forces = vec![0.0; 9];
    for _ in 0..3 {
        contacts.advance(&of_displacement(&[1e-3], &[0.02], 1, Refusal::Masked), &mut forces).unwrap();
        assert!(contacts.failed()[4] && !contacts.failed()[0], "{:?}", contacts.failed());
        assert!(forces.iter().chain(contacts.states()).all(|number| number.is_finite()), "{forces:?}");
    }
}

/// The force of a ball of 35 mm with its jaw at 0.1 m was −6032 N: the formula of its area went on beyond the body.
#[test]
fn a_jaw_beyond_its_body_shows_no_number() {
    const COUNT: usize = 13;
    let linear = (0..COUNT).map(|index| Contact::from(linear(index))).collect();
    for models in [ContactModels::of_each(models(&[5.0], COUNT)), ContactModels::new(linear).unwrap()] {
        let (mut states, mut failed) = (vec![0.0; models.rows() * COUNT], [false; COUNT]);
        let mut before = [0.0; COUNT];
        models
            .step(&mut states, &of_displacement(&[1e-3], &[2e-3], 1, Refusal::All), &mut before, &mut failed)
            .unwrap();
        let is_moved = |index: usize| !index.is_multiple_of(3);
        (0..COUNT).filter(|index| is_moved(*index)).for_each(|index| states[index] = 0.1);
        let (mut forces, mut slopes) = ([0.0; COUNT], [0.0; COUNT]);
        models.show((&states, COUNT), ContactQuantity::Force, 0, &mut forces);
        models.show((&states, COUNT), ContactQuantity::Stiffness, 0, &mut slopes);
        // A masked contact that keeps such a state has no force either.
        let (mut results, refused) = ([7.0; COUNT], of_displacement(&[1e-3], &[f64::NAN], 1, Refusal::Masked));
        models.step(&mut states, &refused, &mut results, &mut failed).unwrap();
        for index in 0..COUNT {
            // A bonded body of constant section is a strip, which may be moved by any way.
            let is_strip = specimen(index).has_constant_section() && separation(index) == Separation::Bonded;
            let is_beyond = is_moved(index) && !is_strip;
            assert_eq!((forces[index].is_nan(), slopes[index].is_nan()), (is_beyond, is_beyond), "{index}");
            let kept = if is_beyond { 0.0 } else { forces[index] };
            assert!(
                failed[index] && (results[index] - kept).abs() <= 1e-12 * kept.abs(),
                "{index}: {}",
                results[index]
            );
            let same = (forces[index] - before[index]).abs() <= 1e-12 * before[index].abs();
            assert!(is_moved(index) || same, "{index}: {} {}", forces[index], before[index]);
        }
    }
}

#[test]
fn all_contacts_are_stepped_or_none() {
    let mut contacts = ContactStates::of_each(models(&[5.0], 11));
    contacts.step(&[1e-3], &[5e-4]).unwrap();
    let before = contacts.clone();
    let mut to = [1e-3; 11];
    to[9] = 1.0;
    let error = contacts.step(&[1e-3], &to).unwrap_err();
    assert!(error.index == 9 && matches!(error.error, StepError::Displacement(_)), "{error}");
    for dt in [-1.0, f64::NAN, f64::INFINITY] {
        let error = contacts.step(&[dt], &[1e-3]).unwrap_err();
        assert!(error.index == 0 && matches!(error.error, StepError::Number { .. }), "{error}");
    }
    let mut force = [0.1; 11];
    force[7] = 1e9;
    let error = contacts.step_force(&[1e-3], &force).unwrap_err();
    assert!(error.index == 7 && matches!(error.error, StepError::Force { .. }), "{error}");
    assert_eq!(contacts, before);
}

/// Of few contacts states are kept, of many they are checked; both leave nothing behind.
#[test]
fn a_refused_step_leaves_states_and_results() {
    for count in [5, 16, 17, 40] {
        let mut together = ContactStates::of_each(models(&[5.0, 1.0], count));
        together.step(&[1e-3], &[1e-3]).unwrap();
        let (old, mut results) = (together.states().to_vec(), vec![7.0; count]);
        let mut to = vec![2e-3; count];
        to[count - 2] = f64::NAN;
        let found = together.advance(&of_displacement(&[1e-3], &to, 1, Refusal::All), &mut results);
        assert_eq!(found.unwrap_err().index, count - 2);
        assert_eq!((together.states(), &results), (&old[..], &vec![7.0; count]));
    }
}

/// A relaxation of no time is none, and one beyond all numbers has ended, at any exponent.
#[test]
fn times_and_rates_beyond_all_numbers_are_steps() {
    for exponent in [0.5, 1.0, 2.7, 5.0, 60.0] {
        let law = LatencyLaw::new(exponent, 20.0).unwrap();
        let end = law.excess_after(0.3, f64::MAX);
        assert!((0.0..0.3).contains(&end), "{exponent}: {end}");
        assert_eq!((law.excess_after(0.3, 0.0), law.excess_after(1e12, 0.0)), (0.3, 1e12));
        let model = ContactModel {
            law,
            ..models(&[5.0], 1).swap_remove(0)
        };
        let mut together = ContactStates::alike(model.clone(), 24);
        together.step(&[1e-3], &[1e-3]).unwrap();
        let (mut dt, mut alone) = (vec![1e-3; 24], together.state(20));
        dt[20] = f64::MAX;
        let force = together.step(&dt, &[2e-3]).unwrap()[20];
        let expected = alone.step(&model, f64::MAX, 2e-3).unwrap();
        assert!((force / expected - 1.0).abs() < 1e-12, "{exponent}: {force} and {expected}");
    }
}

#[test]
fn a_force_that_leaves_no_state_near_the_body_is_refused() {
    let index = 10;
    let model = models(&[5.0], index + 1).swap_remove(index);
    assert!(model.separation == Separation::Bonded && matches!(model.specimen.shape(), Shape::Prism { .. }));
    let mut together = ContactStates::alike(model, 3);
    let found = together.step_force(&[1e-3], &[1e12]).unwrap_err();
    assert!(matches!(found.error, StepError::Force { force } if force == 1e12), "{found}");
    assert!(together.step(&[1e-3], &[1e-3]).is_ok());
}

#[test]
fn masked_contacts_keep_their_state_and_the_others_go_on() {
    for imposed in [Imposed::Displacement, Imposed::Force] {
        let models = models(&[5.0, 3.3], 20);
        let (mut some, mut plain) = (ContactStates::of_each(models.clone()), ContactStates::of_each(models.clone()));
        let (mut results, mut to) = (vec![0.0; 20], vec![1e-3; 20]);
        some.step(&[0.01], &to).unwrap();
        plain.step(&[0.01], &to).unwrap();
        to = if imposed == Imposed::Force { vec![0.05; 20] } else { vec![2e-3; 20] };
        let mut mean = to.clone();
        (mean[3], mean[8], mean[12]) = (f64::NAN, f64::INFINITY, 1e12);
        // A state that is none.
        some.states_mut()[20 + 15] = f64::NAN;
        let step = |to| ContactsStep {
            imposed,
            dt: &[0.01],
            to,
            substeps: 3,
            refusal: Refusal::Masked,
        };
        let before = some.clone();
        assert_eq!(some.advance(&step(&mean), &mut results), Ok(4), "{imposed:?}");
        let mut expected = vec![0.0; 20];
        assert_eq!(plain.advance(&step(&to), &mut expected), Ok(0));
        for index in 0..20 {
            let failed = [3, 8, 12, 15].contains(&index);
            assert_eq!(some.failed()[index], failed, "{imposed:?} {index}");
            let other = if failed { &before } else { &plain };
            let bits = |states: &ContactStates| [0, 20].map(|row| states.states()[row + index].to_bits());
            assert_eq!(bits(&some), bits(other), "{imposed:?} {index}");
            let kept = match imposed {
                Imposed::Displacement if index == 15 => 0.0,
                Imposed::Displacement => before.state(index).force(&models[index]),
                Imposed::Force => 1e-3,
            };
            assert!(
                (results[index] - if failed { kept } else { expected[index] }).abs() < 1e-12,
                "{imposed:?} {index}"
            );
        }
        // None fails any more.
        some.reset(Some(&before.failed().iter().enumerate().map(|(index, _)| index == 15).collect::<Vec<_>>()));
        assert_eq!(some.state(15), ContactState::default());
        assert_eq!(some.advance(&step(&to), &mut results), Ok(0));
        assert!(some.failed().iter().all(|failed| !failed));
    }
}

#[test]
fn values_of_each_contact_are_models_of_each() {
    let mut random = Rng::new(5);
    let mut between = |low: f64, high: f64| (0..37).map(|_| low + (high - low) * random.uniform()).collect::<Vec<_>>();
    let columns = [
        (ContactParameter::LayerThickness, between(2e-3, 8e-3)),
        (ContactParameter::Modulus, between(1e4, 1e5)),
        (ContactParameter::Exponent, between(1.0, 6.0)),
        (ContactParameter::Radius, between(0.02, 0.05)),
        (ContactParameter::RateCoefficient, between(1.0, 1e4)),
    ];
    let base = &models(&[5.0], 1)[0];
    let together = columns
        .iter()
        .try_fold(ContactModels::alike(base.clone()), |models, (parameter, values)| models.with(*parameter, values));
    let mut together = ContactStates::new(together.unwrap(), 37);
    let own = |index: usize| {
        let value = |parameter| columns.iter().find(|(found, _)| *found == parameter).unwrap().1[index];
        let radius = value(ContactParameter::Radius);
        let specimen = Specimen::new(Shape::Ball { radius }, value(ContactParameter::Modulus), base.specimen.sides());
        ContactModel {
            specimen: specimen.unwrap(),
            law: LatencyLaw::new(value(ContactParameter::Exponent), value(ContactParameter::RateCoefficient)).unwrap(),
            layers: Layers::of_thickness(value(ContactParameter::LayerThickness), radius).unwrap(),
            separation: base.separation,
        }
    };
    let models: Vec<ContactModel> = (0..37).map(own).collect();
    let mut each = ContactStates::of_each(models.clone());
    let (mut random, mut places) = (Rng::new(3), vec![0.002; 37]);
    for _ in 0..100 {
        wander(&mut places, &mut random, |_| base.separation == Separation::Bonded);
        let (found, expected) = (together.step(&[0.01], &places).unwrap(), each.step(&[0.01], &places).unwrap());
        assert_eq!(found, expected);
        assert_eq!(together.states(), each.states());
    }
    shows_what_contacts_show(&together, &models);
    assert_eq!(together.step_force(&[0.1], &[0.5]), each.step_force(&[0.1], &[0.5]));
}

#[test]
fn values_that_are_none_are_refused() {
    let ball = || ContactModels::alike(models(&[5.0], 1).swap_remove(0));
    let refused = |parameter, values: Vec<f64>| ball().with(parameter, &values).unwrap_err().to_string();
    assert!(refused(ContactParameter::Modulus, vec![1e4, -1.0]).starts_with("modulus_pa, contact 1: modulus must be"));
    assert!(refused(ContactParameter::Exponent, vec![f64::NAN]).starts_with("exponent, contact 0: exponent n must"));
    assert!(refused(ContactParameter::LayerThickness, vec![1.0]).contains("layer thickness must be above 0 m"));
    let block = ContactModels::alike(models(&[5.0], 3).swap_remove(2));
    let refused = block.with(ContactParameter::Radius, &[0.1]).unwrap_err();
    assert_eq!(refused, ContactModelsError::NoSuchParameter { name: "radius_m" });
    let several = ContactModels::of_each(models(&[5.0], 3));
    let refused = several.with(ContactParameter::Modulus, &[1e4; 3]).unwrap_err();
    assert_eq!(refused.to_string(), "modulus_pa: values for each contact need one model for all, found 3 models");
    let two = ball().with(ContactParameter::Modulus, &[1e4; 2]).unwrap();
    let refused = two.with(ContactParameter::Exponent, &[2.0; 3]).unwrap_err();
    assert_eq!(refused.to_string(), "exponent: expected 2 values, one a contact, found 3");
    let mixed = vec![Contact::from(models(&[5.0], 1).swap_remove(0)), Contact::from(linear(0))];
    assert_eq!(ContactModels::new(mixed), Err(ContactModelsError::Mixed { index: 1 }));
    assert_eq!(ContactModels::new(Vec::new()), Err(ContactModelsError::Empty));
}

#[test]
fn linear_contacts_side_by_side_are_contacts_alone() {
    let contacts: Vec<LinearContact> = (0..29).map(linear).collect();
    let models = ContactModels::new(contacts.iter().cloned().map(Contact::from).collect()).unwrap();
    assert_eq!(models.rows(), 4);
    let mut together = ContactStates::new(models, 29);
    let alone: Vec<_> = contacts
        .iter()
        .map(|contact| crate::simulate::linear::LinearStepper::new(contact.clone()))
        .collect();
    let mut states = vec![(0.0, [0.0; 3]); 29];
    let (mut random, mut places, mut left) = (Rng::new(11), vec![0.002; 29], 0);
    for _ in 0..400 {
        let dt = if random.uniform() < 0.1 { 0.0 } else { 0.05 * random.uniform() };
        wander(&mut places, &mut random, |index| contacts[index].separation == Separation::Bonded);
        let forces = together.step(&[dt], &places).unwrap();
        for (index, (jaw, memory)) in states.iter_mut().enumerate() {
            let (contact, terms) = (&contacts[index], contacts[index].law.terms().len());
            let to = contact.specimen.contact_displacement(places[index]);
            let force = alone[index].step(*jaw, &mut memory[..terms], dt, to).unwrap();
            *jaw = to;
            left += usize::from(!alone[index].is_touching(to, &memory[..terms]));
            assert!((forces[index] - force).abs() < 1e-9, "{index}: {} {force}", forces[index]);
            for (k, x) in memory.iter().enumerate() {
                let found = together.states()[(1 + k) * 29 + index];
                assert!((found - x).abs() < 1e-9, "{index} {k}: {found} {x}");
            }
        }
    }
    assert!(left > 100, "{left} steps without contact");
    let mut shown = vec![0.0; 29];
    together.models().show((together.states(), 29), ContactQuantity::Force, 0, &mut shown);
    let before = together.clone();
    places[4] = f64::NAN;
    assert_eq!(together.step(&[0.1], &places).unwrap_err().index, 4);
    assert_eq!(together, before);
    let mut forces = vec![0.0; 29];
    assert_eq!(together.advance(&of_displacement(&[0.1], &places, 2, Refusal::Masked), &mut forces), Ok(1));
    assert!(together.failed()[4] && forces[4] == shown[4]);
}

#[test]
fn one_term_of_a_linear_law_is_the_latency_law_of_exponent_one() {
    // g = m − 1 and λ = v.
    let model = ContactModel {
        specimen: specimen(0),
        law: LatencyLaw::new(1.0, 0.7).unwrap(),
        layers: Layers::new(6.0).unwrap(),
        separation: Separation::Unilateral,
    };
    let law = LinearLaw::new(&[LinearTerm {
        overshoot: 5.0,
        rate: 0.7,
    }]);
    let contact = LinearContact {
        specimen: specimen(0),
        law: law.unwrap(),
        memory: Memory::Strain,
        separation: Separation::Unilateral,
    };
    let models = ContactModels::new(vec![contact.into()]).unwrap();
    let (mut linear, mut latency) = (ContactStates::new(models, 9), ContactStates::alike(model, 9));
    for tick in 1..2000 {
        let to = 4e-3 * (2e-3 * f64::from(tick)).sin();
        let (found, expected) = (linear.step(&[1e-3], &[to]).unwrap()[8], latency.step(&[1e-3], &[to]).unwrap()[8]);
        // Strang's splitting of the latter is of second order.
        assert!((found - expected).abs() < 1e-5, "{tick}: {found} {expected}");
    }
}

#[test]
#[cfg(feature = "rayon")]
fn the_number_of_threads_changes_no_bit() {
    let count = 140_001;
    let places: Vec<f64> = (0..count).map(|index| 8e-3 * f64::from(index as u32) / 1.4e5 - 1e-3).collect();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut contacts = ContactStates::alike(models(&[2.5], 2).swap_remove(1), count);
            let mut forces = vec![0.0; count];
            for dt in [0.01, 0.3] {
                contacts.advance(&of_displacement(&[dt], &places, 2, Refusal::Masked), &mut forces).unwrap();
            }
            contacts.step_force(&[0.1], &[0.2]).unwrap();
            let (mut states, mut failed) = (contacts.states().to_vec(), vec![false; count]);
            let step = of_displacement(&[0.01], &places, 1, Refusal::All);
            contacts.models().step_on(&pool, true, &mut states, &step, &mut forces, &mut failed).unwrap();
            (contacts, states, forces)
        })
    };
    let one = run(1);
    for threads in [2, 3, 5] {
        assert_eq!(run(threads), one);
    }
    let (mut contacts, ..) = one;
    let mut wrong = places;
    (wrong[139_000], wrong[82_000]) = (1.0, 2.0);
    assert_eq!(contacts.step(&[0.01], &wrong).unwrap_err().index, 82_000);
}
