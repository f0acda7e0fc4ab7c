//! The flags that choose a filter.

use anyhow::Result;
use clap::{Args, ValueEnum};
use infopart::program::BadInput;
use multi_object::motion::{FilterKind, FilterOptions};

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum FilterArg {
    /// Linear Kalman filter
    Kalman,
    /// Extended Kalman filter
    Ekf,
    /// Unscented Kalman filter
    Ukf,
    /// Particle filter
    Pf,
}

#[derive(Debug, Args)]
pub struct FilterArgs {
    /// What predicts a track
    #[arg(long, value_enum, default_value = "kalman")]
    filter: FilterArg,
    /// Particles of a track, for --filter pf
    #[arg(long, default_value_t = 300, value_name = "COUNT")]
    particles: usize,
    /// Seed of the particle filter's draws
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

impl FilterArgs {
    pub fn kind(&self) -> FilterKind {
        match self.filter {
            FilterArg::Kalman => FilterKind::Kalman,
            FilterArg::Ekf => FilterKind::Ekf,
            FilterArg::Ukf => FilterKind::Ukf,
            FilterArg::Pf => FilterKind::Pf,
        }
    }

    pub fn options(&self) -> Result<FilterOptions> {
        if !(1..=1_000_000).contains(&self.particles) {
            let message = format!("--particles {}: give a number from 1 to 1000000", self.particles);
            return Err(BadInput(message).into());
        }
        Ok(FilterOptions { particles: self.particles, seed: self.seed })
    }
}
