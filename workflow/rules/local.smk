# Where an executor hands jobs to other nodes, these stay with it: they need the internet, or the store of MLflow, which
# may be a file of this machine's; or they take a second, which is less than a job on another node takes to start.
localrules:
    retrieve,
    create_store,
    track,
    build_tables,
    summarise,
    draw_campaign_figures,
    build_report,
