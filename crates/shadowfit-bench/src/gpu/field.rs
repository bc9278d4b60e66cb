//! Culling of many instances. Half of them cannot cast shadows into view.

use anyhow::Result;
use shadowfit_wgpu::Culling;

use super::Bench;
use super::passes::with_culling;
use super::scene::BenchScene;
use crate::table::{Table, ms, share};

/// Instances of the field.
const INSTANCES: u16 = 10_000;

pub(crate) fn time(bench: &Bench) -> Result<Table> {
    let scene = BenchScene::field(INSTANCES);
    let ways = [("no culling", Culling::Off), ("whole maps", Culling::WholeMap), ("swept volumes", Culling::Swept)];
    let mut rows = Vec::new();
    let mut unit = [0.0; 3];
    for (name, culling) in ways {
        let taken = with_culling(bench, &scene, culling)?;
        unit = if rows.is_empty() { taken } else { unit };
        let [gpu, cpu, draws] = taken;
        rows.push(vec![
            name.to_owned(),
            ms(gpu),
            share(gpu, unit[0]),
            ms(cpu),
            share(cpu, unit[1]),
            format!("{draws:.0}"),
        ]);
    }
    Ok(Table {
        title: "Culling of 10,000 boxes",
        note: format!(
            "{INSTANCES} boxes, one draw call each, half of them behind the eye and away from the sun. All maps are \
             redrawn. CPU is fit, culling and encoding."
        ),
        columns: ["culling", "GPU", "of none", "CPU", "of none", "draws"].map(str::to_owned).to_vec(),
        rows,
    })
}
