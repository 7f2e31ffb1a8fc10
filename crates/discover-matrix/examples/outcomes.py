import json,sys
o=json.load(open(sys.argv[1]))
flt=sys.argv[2] if len(sys.argv)>2 else 'bad'
FORM=None
for c in o:
    case=c['case']; hid=[h['name'] for h in case['hidden']]; law=case.get('law')
    d=c['deviance']; fs=c['foreseen']
    seen=(not c['failed']) and all(f['detectable'] for f in fs) and (d is None or d['calibrated']-d['truth']>=d['needed'])
    apart=all(not f['class'] for f in fs)
    imit=any(f.get('imitation') and f['imitation']['complete'] for f in fs)
    rej=case['rejected']
    hidden=[h for h in hid if h not in rej]
    F=case['form']; said={'slip':['maxwell-slip-hysteresis','coulomb-friction'],'hardening':['hardening-stiffness'],'frame':['structural-resonance','payload-mass']}.get(F if isinstance(F,str) else list(F)[0],[])
    c['named']=[n for n in c['named'] if n['name'] in hidden or n['name'] not in said]
    wrong=[n['name'] for n in c['named'] if n['name'] not in hidden and not any(a in hidden for a in n['alike'])]
    est=[(e.get('name',''),e.get('parameter','')) for e in c['estimates'] if not e.get('covered',True)]
    p=c.get('posterior') or {}
    best=' | '.join('%s%s %.2f (%.0f)'%('+'.join(e['effects']) or 'nothing',' LAW:'+e['law'] if e['law'] else '',e['probability'],e['ln_odds']) for e in (p.get('best') or [])[:4])
    kind=case['kind']
    bad = wrong or (kind=='clean' and c['verdict'] not in('nothing-missing','undecided') and case['form']=='same') or (kind=='single' and seen and apart and not (c['named'] and c['named'][0]['name'] in hidden)) or (kind in('outside','left-out') and seen and not imit and c['verdict']!='unknown')
    if flt=='bad' and not bad: continue
    if flt not in('bad','all') and flt not in case['id']: continue
    print(case['id'],case['setting']['machine'],case['kind'],'tol',case['setting']['tolerance'],case['noise']['colour'],case['noise']['entry'],round(case['noise']['level'],1),'FORM',case['form'],'HID',[(h['name'],[round(v,6) if isinstance(v,float) else v for v in h.get('values',[])]) for h in case['hidden']],'law',law and (law if isinstance(law,str) else list(law)[0] if isinstance(law,dict) else law),'REJ',rej,'seen' if seen else '','apart' if apart else [len(f['class']) for f in fs],'IMIT' if imit else '')
    print('    ->',c['verdict'],[ (n['name'],n['alike']) for n in c['named']],'WRONG' if wrong else '', 'unk:',c['unknown'] and c['unknown']['depends_on'], 'form %.2f'%p.get('form',-1), 'D cal-truth %.0f found-truth %.0f need %.0f'%(d['calibrated']-d['truth'],d['found']-d['truth'],d['needed']) if d else '')
    print('      ',best, 'TRUTH', [round(x,1) for x in p.get('supposed',[])])
