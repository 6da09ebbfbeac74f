//! `gumption serve`: the workbench in the browser.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::PathBuf;

use super::language::spoken;
use super::{Outcome, output};
use gumption::fault::{harmless, say};
use gumption_serve::Workbench;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The folder whose budgets and experiments are seen and edited
    #[arg(value_name = "FOLDER", default_value = ".")]
    folder: PathBuf,
    /// Port; 0 takes one that is free
    #[arg(long, value_name = "N", default_value_t = 0)]
    port: u16,
    /// Address at which the page is offered. Another than this machine's own lets others on the network in who know the
    /// token, and what they do is not encrypted
    #[arg(long, value_name = "IP", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    address: IpAddr,
}

pub(super) fn run(args: &Args) -> Outcome {
    let address = SocketAddr::new(args.address, args.port);
    let workbench = match Workbench::bind(&args.folder, address) {
        Ok(workbench) => workbench,
        Err(error) => {
            let folder = args.folder.display();
            return output::complain(say!("cannot offer {folder} at {address}: {error}"));
        }
    };
    let page = workbench.address();
    let said = say!(
        "The workbench is open at {page}\nWhoever knows this address may edit the budgets of the folder. Ctrl-C ends it."
    );
    let printed = output::print(harmless(&said.in_language(spoken())).into_owned() + "\n");
    match workbench.run() {
        Ok(()) => printed,
        Err(error) => output::complain(say!("the server has ended: {error}")),
    }
}
